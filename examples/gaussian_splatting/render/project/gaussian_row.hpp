// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <type_traits>

#include "../../model/aosoa.hpp"
#include "../../model/parameters.hpp"
#include "../geometry/vectors.hpp"

namespace gs::raster {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::select;

/// A warp's Gaussians, one a lane: neighbors of a block.
template <class W>
struct gaussian_row {
    std::size_t first;
    mask_t<W> inside;  ///< there is such a Gaussian
    mask_t<W> active;  ///< and the step concerns it

    /// Up to which degree their colors depend on direction, of what a model has: the same in all lanes.
    template <class Real>
    WARPAGG_HD int degree_of(const parameter_arrays<Real>& gaussians, int sh_degree) const {
        return first < gaussians.gaussians_with_sh ? sh_degree : 0;
    }
    /// N components of each, from the k-th on, in an array of `width`. Means nothing in lanes not active.
    template <int N, class Real>
    WARPAGG_HD glm::vec<N, value_t<W, Real>> load(const W& w, const Real* from, std::size_t k,
                                                  std::size_t width) const {
        glm::vec<N, value_t<W, Real>> v;
        WARPAGG_UNROLL
        for (int n = 0; n < N; ++n) {
            if constexpr (whole) {
                // Of the next block: these are too many streams for the hardware to foresee.
                __builtin_prefetch(from + at(k, n, width) +
                                   static_cast<std::ptrdiff_t>(width * block_length));
            }
            v[n] = w.load_row(from, at(k, n, width), touched());
        }
        return v;
    }
    /// Component k + n becomes `value` where `changes`; in other active lanes it stays `before`, as it was
    /// loaded.
    template <class Real>
    WARPAGG_HD void store(const W& w, Real* to, std::size_t k, int n, std::size_t width,
                          const value_t<W, Real>& value, const value_t<W, Real>& before,
                          const mask_t<W>& changes) const {
        w.store_row(to, at(k, n, width), select(active && changes, value, before), touched());
    }
    /// Where component k + n of the first lies.
    WARPAGG_HD std::ptrdiff_t at(std::size_t k, int n, std::size_t width) const {
        return static_cast<std::ptrdiff_t>(aosoa_index(first, k + static_cast<std::size_t>(n), width));
    }

  private:
    /// Where one thread holds all lanes it reads and writes whole rows, which is faster than parts of them:
    /// lanes that are not active get what they had.
    static constexpr bool whole = !std::is_same_v<mask_t<W>, bool>;
    WARPAGG_HD mask_t<W> touched() const { return whole ? mask_t<W>(true) : active; }
};

}  // namespace gs::raster
