// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// How well the training photos' depth maps agree with the scene's points.
struct depth_agreement {
    std::size_t photos = 0, with_map = 0;
    std::size_t told = 0;         ///< maps that know the depths of 10 points in sight or more
    std::size_t agreeing = 0;     ///< of these: what is nearer has more, with a correlation of 0.5 or more
    double correlation = 0;       ///< the median over those that are told of
    std::vector<depth_fit> fits;  ///< by photo, to the unit of cameras and points; no scale for the others
};
depth_agreement compare_depths(const scene& of);
/// In words, with its numbers.
std::string say(const depth_agreement& found);

/// Inverse depths of points beside the values that a map has there.
struct depth_pair {
    double value, inverse_depth;
};
/// The rising line that fits best, and how well.
struct depth_line {
    double scale = 0, offset = 0;
    double correlation = 0;  ///< of what is no outlier; 0, and no scale, where no line rises
};
/// Begins with medians, as Kerbl et al. 2024 (hierarchical 3D Gaussians) find a scale, and goes on with least
/// squares over what lies within 3 standard deviations of the line, 10 times. What is off are the values:
/// points are where several photos agree, and noise of values would make a line through inverse depths too
/// flat. Precondition: there is a pair.
depth_line fit_line(const std::vector<depth_pair>& pairs);

}  // namespace gs::features
