// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../core/bits.hpp"
#include "../../device/atomic.hpp"
#include "../../image/masked_pixel.hpp"
#include "../../metrics/target_image.hpp"
#include "../../model/opacity.hpp"
#include "../../render/geometry/splat.hpp"
#include "../../render/project/geometry.hpp"
#include "../../render/project/project_backward.hpp"
#include "../growth/growth_kernels.hpp"

namespace gs::train {

/// Scores each pixel of a render in two planes: 1 in the first if the pixel is wrong, and 1 in the
/// second. Masked pixels have scores of 0. The third plane is 0. One index per pixel.
struct score_pixels {
    target_image target;  ///< on black
    const float* render;
    std::size_t pixels;
    float level;  ///< mean error of the channels above which a pixel is wrong
    float* scores;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint8_t* photo = target.rgba + 4 * i;
        float error = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float shown = warpagg::math::min(warpagg::math::max(render[c * pixels + i], 0.0f), 1.0f);
            error += glm::abs(shown - static_cast<float>(photo[c]) / 255) / 3;
        }
        const bool counts = !(target.masked && is_masked(photo));
        scores[i] = counts && error > level ? 1 : 0;  // false for NaN
        scores[pixels + i] = counts ? 1 : 0;
        scores[2 * pixels + i] = 0;
    }

  private:
    WARPAGG_HD static bool is_masked(const std::uint8_t* photo) {
        bool equal = true;
        for (int k = 0; k < 4; ++k) equal = equal && photo[k] == ((masked_pixel >> (8 * k)) & 255u);
        return equal;
    }
};

/// What the scored views show of a Gaussian. Weights are alpha times transmittance.
struct error_score {
    float wrong;        ///< sum of its weights in wrong pixels
    float most_weight;  ///< largest sum of its weights in a view
    float views;        ///< number of views that draw it
    float wrong_views;  ///< number of views in which its weights in wrong pixels exceed 0.5
};

/// Adds a view to the scores. One index per Gaussian.
struct add_error_score {
    const std::uint32_t* tiles;
    const float* sums;  ///< see `score_views::sum_scores`, with the scores of `score_pixels`
    error_score* scores;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (tiles[i] == 0) return;
        const float wrong = sums[i * raster::record_stride + raster::sum_red],
                    weight = sums[i * raster::record_stride + raster::sum_green];
        if (!raster::is_finite(wrong) || !raster::is_finite(weight)) return;
        error_score& to = scores[i];
        to.wrong += wrong;
        to.most_weight = warpagg::math::max(to.most_weight, weight);
        to.views += 1;
        if (wrong > 0.5f) to.wrong_views += 1;
    }
};

/// Thresholds of one growth of the strategy `error`.
struct error_limits {
    float gradient;       ///< mean gradient of the center, in halves of the image
    float pixels;         ///< mean sum of weights in wrong pixels
    float dense_scale;    ///< largest cloned scale, in internal units; larger are split
    float least_opacity;  ///< opacity below which Gaussians are removed
};

/// Decides which Gaussians stay and which grow. A Gaussian grows if its gradient is large and the
/// views that draw it show errors, at least two of them if two draw it. Without a view that draws it, the
/// gradient decides. A Gaussian goes if it is transparent, or if three views draw it and none shows
/// half a pixel of it. One index per Gaussian.
struct classify_by_error {
    parameter_arrays<const float> gaussians;
    const raster::visibility* seen;
    const error_score* scores;
    error_limits limits;
    growth_marks marks;

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        const raster::visibility v = seen[i];
        const error_score s = scores[i];
        const float mean = v.seen > 0 ? v.gradient / v.seen : 0.0f;
        if (v.seen > 0 && v.gradient == 0) device::atomic_add(marks.without_gradient, 1);
        const glm::vec3 scale = raster::load3(gaussians.log_scale, i);
        const float largest = glm::exp(warpagg::math::max(scale.x, warpagg::math::max(scale.y, scale.z)));
        const bool is_unused = s.views >= 3 && s.most_weight < 0.5f;
        const bool stay = sigmoid(gaussians.opacity[i]) >= limits.least_opacity && !is_unused;
        const bool is_wrong =
            s.wrong >= limits.pixels * s.views && s.wrong_views >= warpagg::math::min(2.0f, s.views);
        marks.stays[i] = stay ? 1 : 0;
        marks.large[i] = largest > limits.dense_scale ? 1 : 0;
        marks.identities[i] = i;
        const bool grows = stay && mean >= limits.gradient && is_wrong;
        // Positive floats have the same order as their bits; the complement reverses it.
        marks.key[i] = grows ? ~raster::bits_of(mean) : growth_marks::never;
    }
};

/// Rates Gaussians by the pixels that the best view shows of them, and marks all of them to stay.
/// One index per Gaussian.
struct rate_by_weight {
    const error_score* scores;
    growth_marks marks;

    WARPAGG_HD void operator()(std::size_t i) const {
        marks.stays[i] = 1;
        marks.key[i] = raster::bits_of(scores[i].most_weight);
        marks.identities[i] = static_cast<std::uint32_t>(i);
    }
};

}  // namespace gs::train
