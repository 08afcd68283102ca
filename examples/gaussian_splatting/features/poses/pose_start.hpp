// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "pose_change.hpp"

namespace gs::features {

/// Limits of a step of Adam for a pose, in radians. About fifty steps of the given limit can correct an error
/// of two degrees. Corrected poses need small steps only: larger ones would move them away again while the
/// first Gaussians are still inexact.
/// @{
inline constexpr float step_from_given = 2e-3f, step_from_corrected = 2e-4f;
/// @}

/// How training of a pose begins.
struct pose_start {
    pose_change change{};
    float largest_step = step_from_given;
};

/// The initial values of the feature: for each training view `numbers_of` its given pose, and its start.
/// @{
inline constexpr std::size_t start_width = given_width + pose_width + 1;
std::vector<float> initial_values(const std::vector<given_pose>& given,
                                  const std::vector<pose_start>& starts);
std::vector<pose_start> starts_in(const std::vector<float>& values);
/// @}

}  // namespace gs::features
