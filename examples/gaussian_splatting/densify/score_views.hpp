// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../metrics/target_image.hpp"
#include "../render/geometry/splat.hpp"

namespace gs::train {

/// A training view that `score_views` has drawn. All pointers are to memory of the device and are valid
/// until the next `draw`.
struct drawn_view {
    target_image target;                 ///< the training image, on black
    const float* render;                 ///< three planes, not clamped, on black
    const raster::splat<float>* splats;  ///< one for each Gaussian
    const std::uint32_t* tiles;  ///< for each Gaussian, the tiles that it may touch; 0: it is not drawn
};

/// Draws training views and sums scores of pixels for each Gaussian.
class score_views {
  public:
    virtual ~score_views() = default;
    /// Number of training views.
    virtual std::size_t count() const = 0;
    virtual drawn_view draw(std::size_t view) = 0;
    /// Sums `scores` over the pixels of the view drawn last. `scores` has three planes of values between -1
    /// and 1. Gaussian i receives the sum of score times w_i, its alpha times transmittance in that pixel.
    /// The result has `raster::record_stride` values for each Gaussian: those at `raster::sum_red`,
    /// `sum_green` and `sum_blue` belong to the first, second and third plane. Valid until the next call or
    /// `draw`; only for Gaussians that are drawn. Costs one backward blending.
    virtual const float* sum_scores(const float* scores) = 0;
};

}  // namespace gs::train
