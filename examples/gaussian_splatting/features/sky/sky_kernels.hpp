// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/atomic.hpp>

#include "../../model/gaussians.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../../optimize/ordered_sums.hpp"
#include "../../render/geometry/fisheye.hpp"
#include "../../render/geometry/panorama.hpp"
#include "../pixel_patch.hpp"

namespace gs::features {

/// The number of SH coefficients per channel of a sky. Its color in a direction is 0.5 plus the sum
/// of coefficients times harmonics, as for a Gaussian, but is not clamped.
inline constexpr unsigned sky_coefficients = sh_coefficients(sky_degree);

/// The directions of a patch of pixels through a lens.
template <class W, lens_model Lens>
struct sky_patch : pixel_patch<W> {
    using real = warpagg::value_t<W, float>;

    using pixel_patch<W>::pixel_patch;

    /// Computes the harmonics in the directions of a row's pixels.
    WARPAGG_HD void basis(const W& w, const raster::device_camera<real>& camera, int row,
                          real (&values)[sky_coefficients]) const {
        const real x = warpagg::math::convert<float>(w.lane() + this->left) + real(0.5f);
        const raster::vec2<real> place((x - camera.cx) / camera.fx,
                                       (real(static_cast<float>(row) + 0.5f) - camera.cy) / camera.fy);
        raster::vec3<real> ray(place, real(1));
        if constexpr (Lens == lens_model::fisheye) ray = raster::fisheye_ray(place, camera);
        if constexpr (Lens == lens_model::panorama) ray = raster::panorama_ray(place);
        sh_basis(sky_degree, raster::unit<3, real>(ray * camera.rotation).direction, values);
    }
};

/// Draws the sky behind an image. One warp per patch.
template <class W, lens_model Lens>
struct draw_sky {
    using real = warpagg::value_t<W, float>;

    raster::device_camera<real> camera;
    const float* sky;
    float* planes;  ///< three planes of the result

    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        const sky_patch<W, Lens> patch(w, index, camera.width, camera.height);
        const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(camera.width) * camera.height;
        for (int row = patch.first; row < patch.last; ++row) {
            real basis[sky_coefficients];
            patch.basis(w, camera, row, basis);
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                real color(0.5f);
                WARPAGG_UNROLL
                for (unsigned k = 0; k < sky_coefficients; ++k)
                    color = warpagg::math::fma(basis[k], real(sky[3 * k + c]), color);
                w.store_row(planes, c * plane + static_cast<std::ptrdiff_t>(row) * camera.width + patch.left,
                            color, patch.inside);
            }
        }
    }
};

/// Sums the gradient with respect to the sky's coefficients, from the gradient with respect to the
/// render and the transmittance of each pixel. One warp per patch.
template <class W, lens_model Lens>
struct sky_backward {
    using real = warpagg::value_t<W, float>;

    raster::device_camera<real> camera;
    const float* transmittance;
    const float* by_render;    ///< three planes
    train::ordered_sums sums;  ///< sums over all patches of the image
    unsigned first_patch;

    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        const unsigned index = first_patch + warp;
        const sky_patch<W, Lens> patch(w, index, camera.width, camera.height);
        const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(camera.width) * camera.height;
        real total[sky_width];
        WARPAGG_UNROLL
        for (unsigned i = 0; i < sky_width; ++i) total[i] = real(0);
        for (int row = patch.first; row < patch.last; ++row) {
            const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row) * camera.width + patch.left;
            const real T = w.load_row(transmittance, at, patch.inside);
            real basis[sky_coefficients];
            patch.basis(w, camera, row, basis);
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                const real g = T * w.load_row(by_render, c * plane + at, patch.inside);
                WARPAGG_UNROLL
                for (unsigned k = 0; k < sky_coefficients; ++k)
                    total[3 * k + c] = warpagg::math::fma(basis[k], g, total[3 * k + c]);
            }
        }
        const auto part = [&, index](unsigned i) { return sums(i, index); };
        warpagg::warp_reduce_atomic(w, part, total, warpagg::mask_t<W>(true));
    }
};

}  // namespace gs::features
