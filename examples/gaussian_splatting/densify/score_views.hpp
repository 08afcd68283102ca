// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../metrics/target_image.hpp"
#include "../ranks/shares.hpp"
#include "../render/geometry/splat.hpp"

namespace gs::train {

/// A training view that `score_views` has rendered. All pointers are to device memory and are valid
/// until the next `draw`.
struct drawn_view {
    target_image target;  ///< the training image, on black
    /// Three planes, not clamped, on black. With several ranks, each one renders some of the rows, and
    /// `sum_scores` uses the scores in these; the other rows are undefined.
    const float* render;
    const raster::splat<float>* splats;  ///< one per Gaussian of this rank
    const std::uint32_t* tiles;          ///< tiles that each of these may touch; 0 if not drawn
};

/// Renders training views and sums scores of pixels for each Gaussian. Several ranks share this work, and
/// all of them must call the functions that are not const.
class score_views {
  public:
    virtual ~score_views() = default;
    /// Returns the number of training views.
    virtual std::size_t count() const = 0;
    virtual drawn_view draw(std::size_t view) = 0;
    /// Sums `scores` over the pixels of the view of the last `draw`. `scores` has three planes of
    /// values between -1 and 1. Gaussian i receives the sum of score times w_i, its alpha times the
    /// transmittance in that pixel. The result has `raster::record_stride` values per Gaussian:
    /// those at `raster::sum_red`, `sum_green` and `sum_blue` belong to the first, second and third
    /// plane. It is valid until the next call or `draw`, and only for Gaussians of this rank that are drawn.
    /// Cost: one blend backward pass.
    virtual const float* sum_scores(const float* scores) = 0;
    /// Gives all ranks the values that others have for their Gaussians. The array has a value, or a
    /// structure, for each Gaussian.
    virtual void gather(const ranks::shared_array& array) = 0;
};

}  // namespace gs::train
