// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "small_view.hpp"

namespace gs::stereo {

/// The inverse distances from the camera that a sweep tries: `steps` values with equal differences.
struct sweep_range {
    double farthest = 0, nearest = 1;
    int steps = 2;

    double at(double step) const { return farthest + (nearest - farthest) * step / (steps - 1); }
};

/// Returns the inverse distance of the surface in each pixel, or 0 where it is uncertain. Tries each
/// distance for all pixels (plane sweeping, Collins 1996, with spheres around the camera, so that it works
/// for all lenses), and keeps the one at which squares of 5×5 pixels correlate best with the other views.
/// The measure is the mean normalized cross-correlation with the two most similar views, which ignores
/// exposure. Uncertain are smooth squares, weak maxima, and maxima with a rival.
///
/// Preconditions: there are at least two steps, and one other view. Cost: steps times pixels times views.
std::vector<float> sweep(const small_view& reference, const std::vector<const small_view*>& others,
                         const sweep_range& range);

}  // namespace gs::stereo
