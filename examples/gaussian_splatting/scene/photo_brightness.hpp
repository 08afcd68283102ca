// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "observations.hpp"

namespace gs {

/// The relative brightness of each photo, measured at the points that it shares with other photos:
/// log2 of a factor on displayed values. Its mean over photos that share points is zero.
struct photo_brightness {
    std::vector<double> log2;   ///< one per photo; zero for photos with too few points
    std::vector<double> error;  ///< standard errors; zero for photos with too few points
    std::size_t points = 0;     ///< number of points with which they were measured
    bool is_rough = false;      ///< whether these include points in rough parts of photos
};

/// Estimates the brightness by least squares over points and photos with Huber weights, in ten
/// rounds of reweighting. `points` holds the observations of each point, and `photos` is the number
/// of photos.
photo_brightness estimate_brightness(const std::vector<std::vector<observation>>& points, std::size_t photos);

}  // namespace gs
