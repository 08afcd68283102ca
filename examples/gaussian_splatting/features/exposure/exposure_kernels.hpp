// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>
#include <warpagg/atomic.hpp>

#include "../../optimize/ordered_sums.hpp"
#include "../pixel_patch.hpp"

namespace gs::features {

/// The number of values of an exposure, which maps a rendered color c to `A c + b`. It has three
/// rows, each with three elements of A and one of b, as in Kerbl et al. 2024 (hierarchical 3D
/// Gaussians).
inline constexpr unsigned exposure_width = 12;

/// Returns the index of element k of row `channel` of A, or of its element of b for k = 3.
WARPAGG_HD constexpr unsigned exposure_at(unsigned channel, unsigned k) { return 4 * channel + k; }

using exposure = std::array<float, exposure_width>;
inline constexpr exposure identity_exposure{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// Converts exposures to the values of the feature, or back.
/// @{
inline std::vector<float> flattened(const std::vector<exposure>& all) {
    std::vector<float> values;
    for (const exposure& e : all) values.insert(values.end(), e.begin(), e.end());
    return values;
}
inline std::vector<exposure> exposures_from(const std::vector<float>& values) {
    std::vector<exposure> all(values.size() / exposure_width);
    for (std::size_t i = 0; i < all.size() * exposure_width; ++i)
        all[i / exposure_width][i % exposure_width] = values[i];
    return all;
}
/// @}

/// Applies an exposure to a render. One index per pixel.
struct expose {
    const float* render;  ///< three planes, like `exposed`
    const float* exposure;
    std::size_t pixels;
    float* exposed;

    WARPAGG_HD void operator()(std::size_t i) const {
        for (unsigned c = 0; c < 3; ++c) {
            float sum = exposure[exposure_at(c, 3)];
            for (unsigned k = 0; k < 3; ++k)
                sum = warpagg::math::fma(exposure[exposure_at(c, k)], render[k * pixels + i], sum);
            exposed[c * pixels + i] = sum;
        }
    }
};

/// Computes the gradients with respect to the render and the exposure, from the gradient with
/// respect to the exposed render. One warp per patch.
struct expose_backward {
    const float* render;  ///< three planes, like all images here
    const float* exposure;
    const float* by_exposed;
    int width, height;
    float* by_render;
    train::ordered_sums sums;  ///< sums over all patches of the image
    unsigned first_patch;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        using real = warpagg::value_t<W, float>;
        const unsigned index = first_patch + warp;
        const pixel_patch<W> patch(w, index, width, height);
        const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(width) * height;
        real total[exposure_width];
        WARPAGG_UNROLL
        for (unsigned i = 0; i < exposure_width; ++i) total[i] = real(0);
        for (int row = patch.first; row < patch.last; ++row) {
            const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * width + patch.left;
            real color[3], g[3];
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                color[c] = w.load_row(render, c * plane + first, patch.inside);
                g[c] = w.load_row(by_exposed, c * plane + first, patch.inside);
            }
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                WARPAGG_UNROLL
                for (unsigned k = 0; k < 3; ++k)
                    total[exposure_at(c, k)] = warpagg::math::fma(g[c], color[k], total[exposure_at(c, k)]);
                total[exposure_at(c, 3)] += g[c];
                real by(0);
                WARPAGG_UNROLL
                for (unsigned k = 0; k < 3; ++k)
                    by = warpagg::math::fma(g[k], real(exposure[exposure_at(k, c)]), by);
                w.store_row(by_render, c * plane + first, by, patch.inside);
            }
        }
        const auto part = [&, index](unsigned i) { return sums(i, index); };
        warpagg::warp_reduce_atomic(w, part, total, warpagg::mask_t<W>(true));
    }
};

/// Shifts all exposures by the same amount, so that their mean is the identity. Otherwise all
/// exposures could become brighter and the scene darker. One index per value of an exposure.
struct normalize_exposures {
    float* exposures;
    std::size_t views;

    WARPAGG_HD void operator()(std::size_t i) const {
        float sum = 0;
        for (std::size_t v = 0; v < views; ++v) sum += exposures[v * exposure_width + i];
        const float excess = sum / static_cast<float>(views) - (i % 5 == 0 ? 1.0f : 0.0f);
        for (std::size_t v = 0; v < views; ++v) exposures[v * exposure_width + i] -= excess;
    }
};

}  // namespace gs::features
