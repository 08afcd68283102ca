// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// The agreement of the training photos' depth maps with the scene's points.
struct depth_agreement {
    std::size_t photos = 0, with_map = 0;
    std::size_t told = 0;              ///< number of maps with values at 10 visible points or more
    std::size_t agreeing = 0;          ///< number of these with `least_correlation` or more
    double correlation = 0;            ///< median correlation of the `told` maps
    std::vector<depth_fit> fits;       ///< by photo, values to inverse depths; scale 0: not agreeing
    std::vector<double> correlations;  ///< by photo; NaN for maps that are not `told`

    static constexpr double least_correlation = 0.5;  ///< of a map that agrees
};
/// Compares the depth maps of all training photos with the scene's points.
depth_agreement compare_depths(const scene& of);
/// Returns a sentence about the agreement, with its figures.
std::string say(const depth_agreement& found);

/// A depth map's value at a visible point, and the inverse depth of the point.
struct depth_pair {
    double value, inverse_depth;
};
/// An increasing line from values to inverse depths.
struct depth_line {
    double scale = 0, offset = 0;
    double correlation = 0;  ///< without outliers; 0, with scale 0, if no line increases
};
/// Fits a line to pairs. Begins with medians, as Kerbl et al. 2024 (hierarchical 3D Gaussians) find
/// a scale. Then repeats 10 times a least-squares fit over the pairs within 3 standard deviations
/// of the line. The fit minimizes errors of the values, because the points are accurate; noise in
/// the values would otherwise make the line too flat. Precondition: `pairs` is not empty.
depth_line fit_line(const std::vector<depth_pair>& pairs);

}  // namespace gs::features
