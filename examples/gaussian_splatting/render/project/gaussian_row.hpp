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

/// The Gaussians of a warp, one per lane. They are neighbors in one AoSoA block.
template <class W>
struct gaussian_row {
    std::size_t first;
    mask_t<W> inside;  ///< whether the lane has a Gaussian
    mask_t<W> active;  ///< whether it also takes part

    /// Returns the SH degree of all lanes in a model of degree `sh_degree`.
    template <class Real>
    WARPAGG_HD int degree_of(const parameter_arrays<Real>& gaussians, int sh_degree) const {
        return first < gaussians.gaussians_with_sh ? sh_degree : 0;
    }
    /// Returns the slot of the row's block in the cache, or 0: see `parameter_arrays::cache_slot`.
    template <class Real>
    WARPAGG_HD std::uint32_t cache_slot(const parameter_arrays<Real>& gaussians) const {
        return gaussians.cache_slot == nullptr ? 0 : gaussians.cache_slot[first / block_length];
    }
    /// Loads the components k to k + N - 1 of each Gaussian from an array with `width` components
    /// per Gaussian. The values in inactive lanes are unspecified.
    template <int N, class Real>
    WARPAGG_HD glm::vec<N, value_t<W, Real>> load(const W& w, const Real* from, std::size_t k,
                                                  std::size_t width) const {
        glm::vec<N, value_t<W, Real>> v;
        WARPAGG_UNROLL
        for (int n = 0; n < N; ++n) {
            if constexpr (whole) {
                // Prefetches the next block: hardware prefetchers track fewer streams.
                __builtin_prefetch(from + at(k, n, width) +
                                   static_cast<std::ptrdiff_t>(width * block_length));
            }
            v[n] = w.load_row(from, at(k, n, width), touched());
        }
        return v;
    }
    /// Stores `value` as component k + n in active lanes where `changes`. Other lanes keep
    /// `before`, which must be the value that was loaded.
    template <class Real>
    WARPAGG_HD void store(const W& w, Real* to, std::size_t k, int n, std::size_t width,
                          const value_t<W, Real>& value, const value_t<W, Real>& before,
                          const mask_t<W>& changes) const {
        w.store_row(to, at(k, n, width), select(active && changes, value, before), touched());
    }
    /// Returns the index of component k + n of the first Gaussian.
    WARPAGG_HD std::ptrdiff_t at(std::size_t k, int n, std::size_t width) const {
        return static_cast<std::ptrdiff_t>(aosoa_index(first, k + static_cast<std::size_t>(n), width));
    }

  private:
    /// Whether one thread holds all lanes. It then reads and writes whole rows, which is faster
    /// than masked access, and inactive lanes write back the values that they have loaded.
    static constexpr bool whole = !std::is_same_v<mask_t<W>, bool>;
    WARPAGG_HD mask_t<W> touched() const { return whole ? mask_t<W>(true) : active; }
};

/// Where the components of a parameter lie, or values that belong to them, for the Gaussians of a row: in
/// its arrays, or in the cache.
template <class W>
struct row_place {
    gaussian_row<W> row;
    parameter p;
    bool is_cached;

    /// `cache_slot`: see `gaussian_row::cache_slot`.
    WARPAGG_HD row_place(const gaussian_row<W>& of, parameter which, std::uint32_t cache_slot)
        : row(of), p(which), is_cached(cache_slot != 0 && which > parameter::sh0) {
        if (is_cached) row.first = (cache_slot - 1) * block_length + of.first % block_length;
    }
    template <class Real>
    WARPAGG_HD Real* array(const parameter_arrays<Real>& all) const {
        // An index instead of a choice between two pointers saves instructions.
        return p > parameter::sh0 ? all.sh[degree_of(p) + (is_cached ? 4 : 0)] : all[p];
    }
};

}  // namespace gs::raster
