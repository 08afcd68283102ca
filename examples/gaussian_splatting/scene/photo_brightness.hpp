// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "observations.hpp"

namespace gs {

/// How much brighter than the others each photo shows the points that they share, as log2 of a factor on
/// displayed values. The mean over photos that share points is zero.
struct photo_brightness {
    std::vector<double> log2;   ///< one per photo; zero for photos that share too few points with others
    std::vector<double> error;  ///< standard error of each; zero for those photos
};

/// Least squares over points and photos with Huber's weights, in ten rounds of conjugate gradients. `points`
/// holds the observations of each point, `photos` is the number of photos.
photo_brightness estimate_brightness(const std::vector<std::vector<observation>>& points, std::size_t photos);

}  // namespace gs
