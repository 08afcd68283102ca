// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/atomic.hpp>

#include "../../optimize/ordered_sums.hpp"
#include "../pixel_patch.hpp"

namespace gs::features {

/// The falloff of a lens: the factor by which a color channel of the image is darker than at the principal
/// point. It is V(u) = 1 / (1 + b0 B0(u) + b1 B1(u) + b2 B2(u)), where u is the squared distance from the
/// principal point relative to that of the farthest corner. Each B is a sum of Bernstein polynomials of
/// degree 3 that increases from 0 to 1, and no parameter b is negative. So V is 1 at the principal point,
/// never increases outward and is positive. Equal parameters give 1 / (1 + q u). In displayed values, this is
/// about natural vignetting, cos^4 of the angle in linear light. Polynomials of vignetting: Goldman 2010;
/// Deutsch et al. 2026 (PPISP) learn them with a radiance field.
inline constexpr unsigned falloff_terms = 3;

/// The number of parameters of a falloff: `falloff_terms` for each color channel.
inline constexpr unsigned falloff_width = 3 * falloff_terms;

/// Returns the index of the parameter of a term of a channel.
WARPAGG_HD constexpr unsigned falloff_at(unsigned channel, unsigned term) {
    return falloff_terms * channel + term;
}

/// Computes the values of B at u, a number or lanes of numbers.
template <class Number>
WARPAGG_HD void falloff_basis(const Number& u, Number (&basis)[falloff_terms]) {
    basis[0] = u * (Number(3) - u * (Number(3) - u));
    basis[1] = u * u * (Number(3) - u - u);
    basis[2] = u * u * u;
}

/// Returns V of one channel, with the values of B and the parameters of the channel.
template <class Number, class Parameter>
WARPAGG_HD Number falloff(const Number (&basis)[falloff_terms], const Parameter* parameters) {
    Number sum(1);
    WARPAGG_UNROLL
    for (unsigned k = 0; k < falloff_terms; ++k) sum += Number(parameters[k]) * basis[k];
    return Number(1) / sum;
}

/// Where the pixels of an image are relative to the optical axis.
struct falloff_geometry {
    int width, height;
    float cx, cy;          ///< principal point, in pixels
    float inverse_square;  ///< 1 / (squared distance of the farthest corner)

    /// Returns u at the pixels of a row of a patch.
    template <class W>
    WARPAGG_HD warpagg::value_t<W, float> radius(const W& w, const pixel_patch<W>& patch, int row) const {
        using real = warpagg::value_t<W, float>;
        const real x = warpagg::math::convert<float>(w.lane() + patch.left) + real(0.5f - cx);
        const float y = static_cast<float>(row) + 0.5f - cy;
        return (x * x + real(y * y)) * real(inverse_square);
    }
};

/// Applies a falloff to an image. One warp per patch.
struct darken_corners {
    const float* image;  ///< three planes, like `darkened`
    const float* parameters;
    falloff_geometry geometry;
    float* darkened;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = warpagg::value_t<W, float>;
        const pixel_patch<W> patch(w, index, geometry.width, geometry.height);
        const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(geometry.width) * geometry.height;
        for (int row = patch.first; row < patch.last; ++row) {
            const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * geometry.width + patch.left;
            real basis[falloff_terms];
            falloff_basis(geometry.radius(w, patch, row), basis);
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                const real factor = falloff(basis, parameters + falloff_at(c, 0));
                const real color = w.load_row(image, c * plane + first, patch.inside);
                w.store_row(darkened, c * plane + first, factor * color, patch.inside);
            }
        }
    }
};

/// Computes the gradients with respect to the image and the parameters, from the gradient with respect to
/// the result of `darken_corners`. One warp per patch.
struct darken_corners_backward {
    const float* image;  ///< three planes, like all images here
    const float* parameters;
    const float* by_darkened;
    falloff_geometry geometry;
    float* by_image;
    train::ordered_sums sums;  ///< sums over all patches of the image
    unsigned first_patch;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        using real = warpagg::value_t<W, float>;
        const unsigned index = first_patch + warp;
        const pixel_patch<W> patch(w, index, geometry.width, geometry.height);
        const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(geometry.width) * geometry.height;
        real total[falloff_width];
        WARPAGG_UNROLL
        for (unsigned i = 0; i < falloff_width; ++i) total[i] = real(0);
        for (int row = patch.first; row < patch.last; ++row) {
            const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * geometry.width + patch.left;
            real basis[falloff_terms];
            falloff_basis(geometry.radius(w, patch, row), basis);
            WARPAGG_UNROLL
            for (unsigned c = 0; c < 3; ++c) {
                const real factor = falloff(basis, parameters + falloff_at(c, 0));
                const real color = w.load_row(image, c * plane + first, patch.inside);
                const real g = w.load_row(by_darkened, c * plane + first, patch.inside);
                w.store_row(by_image, c * plane + first, factor * g, patch.inside);
                const real by_sum = -(g * color * factor * factor);
                WARPAGG_UNROLL
                for (unsigned k = 0; k < falloff_terms; ++k)
                    total[falloff_at(c, k)] = warpagg::math::fma(by_sum, basis[k], total[falloff_at(c, k)]);
            }
        }
        const auto part = [&, index](unsigned i) { return sums(i, index); };
        warpagg::warp_reduce_atomic(w, part, total, warpagg::mask_t<W>(true));
    }
};

/// Sets negative parameters to zero. One index per parameter.
struct keep_falling {
    float* parameters;

    WARPAGG_HD void operator()(std::size_t i) const {
        parameters[i] = warpagg::math::max(parameters[i], 0.0f);
    }
};

}  // namespace gs::features
