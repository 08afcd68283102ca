// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../scene/orbit.hpp"
#include "../scene/scene.hpp"

namespace gs::live {

/// Returns the JSON from which a page begins: the first camera, the point that it turns around, and
/// the training views with their cameras.
std::string scene_json(const orbit& around, const std::vector<view>& views);

}  // namespace gs::live
