// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

#include "transforms.hpp"

namespace gs {

/// Sets the pose from a camera-to-world matrix of finite numbers, whose camera looks along -z with
/// y up. Throws `error`, which begins with `where`, unless the matrix is a rotation and a
/// translation to within 1e-3.
void set_pose(transforms_frame& frame, const glm::dmat4& matrix, const std::string& where);

}  // namespace gs
