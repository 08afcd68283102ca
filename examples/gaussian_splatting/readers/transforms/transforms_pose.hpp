// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

#include "transforms.hpp"

namespace gs {

/// Sets the pose from the file's camera-to-world matrix, of finite numbers, whose camera looks along -z with
/// y up. Throws `error` beginning with `where` unless it is, to 1e-3, a rotation and a translation.
void set_pose(transforms_frame& frame, const glm::dmat4& matrix, const std::string& where);

}  // namespace gs
