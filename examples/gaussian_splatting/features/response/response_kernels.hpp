// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/atomic.hpp>

#include "../../optimize/ordered_sums.hpp"
#include "../pixel_patch.hpp"

namespace gs::features {

/// The response of a camera: the curve R that maps a color channel of the exposed render to that of the
/// photo. R is a Bernstein polynomial whose coefficients are the sums of the first increments, relative to
/// the sum of all. No increment is negative, so R never falls, R(0) = 0 and R(1) = 1. Equal increments give
/// the identity. Curves of cameras: Debevec and Malik 1997; Grossberg and Nayar 2004. PPISP (Deutsch et al.
/// 2026) learns others with a radiance field.
inline constexpr unsigned response_degree = 5;

/// The number of increments of a camera: `response_degree` for each color channel.
inline constexpr unsigned response_width = 3 * response_degree;

/// Returns the index of an increment of a channel.
WARPAGG_HD constexpr unsigned response_at(unsigned channel, unsigned increment) {
    return response_degree * channel + increment;
}

/// The functions by which increments contribute to a curve and to its slope, at one brightness or in lanes.
template <class Number>
struct response_basis {
    Number curve[response_degree];
    Number slope[response_degree];

    /// Precondition: x is from 0 to 1.
    explicit WARPAGG_HD response_basis(const Number& x) {
        const Number rest = Number(1) - x;
        Number b[response_degree + 1];  // Bernstein polynomials, whose degree rises
        b[0] = Number(1);
        WARPAGG_UNROLL
        for (unsigned degree = 1; degree <= response_degree; ++degree) {
            if (degree == response_degree)
                for (unsigned k = 0; k < response_degree; ++k) slope[k] = Number(response_degree) * b[k];
            b[degree] = x * b[degree - 1];
            WARPAGG_UNROLL
            for (unsigned k = degree - 1; k > 0; --k) b[k] = x * b[k - 1] + rest * b[k];
            b[0] *= rest;
        }
        Number sum(0);
        WARPAGG_UNROLL
        for (unsigned k = response_degree; k > 0; --k) {
            sum += b[k];
            curve[k - 1] = sum;
        }
    }
};

/// Returns the sum of functions of `response_basis`, weighted with the increments of a channel.
template <class Number, class Increment>
WARPAGG_HD Number weighted(const Number (&functions)[response_degree], const Increment* increments) {
    Number sum(0), all(0);
    WARPAGG_UNROLL
    for (unsigned k = 0; k < response_degree; ++k) {
        sum += Number(increments[k]) * functions[k];
        all += Number(increments[k]);
    }
    return sum / all;
}

/// Returns R(x) of a channel. Clamps x to [0, 1], as a sensor does.
template <class Number, class Increment>
WARPAGG_HD Number respond(const Number& x, const Increment* increments) {
    const response_basis<Number> basis(warpagg::math::min(warpagg::math::max(x, Number(0)), Number(1)));
    return weighted(basis.curve, increments);
}

/// Applies a response to a render. One index per pixel.
struct apply_response {
    const float* render;  ///< three planes, like `shown`
    const float* increments;
    std::size_t pixels;
    float* shown;

    WARPAGG_HD void operator()(std::size_t i) const {
        for (unsigned c = 0; c < 3; ++c)
            shown[c * pixels + i] = respond(render[c * pixels + i], increments + response_at(c, 0));
    }
};

/// Computes the gradients with respect to the render and the increments, from the gradient with respect to
/// the result of `apply_response`. A render beyond [0, 1] is shown as the end of that range, so its gradient
/// would be zero, and a photo could never draw it back. It gets the gradient at the end if that draws it
/// toward the range, and zero otherwise. One warp per patch.
struct respond_backward {
    const float* render;  ///< three planes, like all images here
    const float* increments;
    const float* by_shown;
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
        real total[response_width];
        WARPAGG_UNROLL
        for (unsigned i = 0; i < response_width; ++i) total[i] = real(0);
        for (int row = patch.first; row < patch.last; ++row) {
            const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * width + patch.left;
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                const float* own = increments + response_at(c, 0);
                const real x = w.load_row(render, c * plane + first, patch.inside);
                const real g = w.load_row(by_shown, c * plane + first, patch.inside);
                const response_basis<real> basis(warpagg::math::min(warpagg::math::max(x, real(0)), real(1)));
                const auto points_away = (x < real(0) && g > real(0)) || (x > real(1) && g < real(0));
                const real by = g * weighted(basis.slope, own);
                w.store_row(by_render, c * plane + first, warpagg::math::select(points_away, real(0), by),
                            patch.inside);
                const real shown = weighted(basis.curve, own);
                WARPAGG_UNROLL
                for (unsigned k = 0; k < response_degree; ++k)
                    total[response_at(c, k)] =
                        warpagg::math::fma(g, basis.curve[k] - shown, total[response_at(c, k)]);
            }
        }
        const auto part = [&, index](unsigned i) { return sums(i, index); };
        warpagg::warp_reduce_atomic(w, part, total, warpagg::mask_t<W>(true));
    }
};

/// Makes increments positive and their sum 1. One index per channel of a camera.
struct keep_rising {
    float* increments;

    /// The smallest increment before the division. It keeps the slope of the curve above zero, so that
    /// gradients reach the render everywhere.
    static constexpr float least = 0.01f;

    WARPAGG_HD void operator()(std::size_t channel) const {
        float* own = increments + response_at(static_cast<unsigned>(channel), 0);
        float sum = 0;
        for (unsigned k = 0; k < response_degree; ++k) {
            own[k] = warpagg::math::max(own[k], least);
            sum += own[k];
        }
        for (unsigned k = 0; k < response_degree; ++k) own[k] /= sum;
    }
};

}  // namespace gs::features
