// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

namespace gs::lab {

/// A warp whose atomics are none: a load, an add and a store (the paper, Figure 5). Of lanes that add to the
/// same place one wins, as of warps that do so at the same time: the sums are wrong.
template <class W>
struct plain_warp : W {
    template <class Op, class Dst, class V>
    WARPAGG_HD void atomic(Op, Dst dst, const warpagg::value_t<W, unsigned>& index, const V& v,
                           const warpagg::mask_t<W>& active) const {
        auto* to = dst(0u);
        this->store(to, index, Op::combine(this->load(to, index, active), v), active);
    }
};

/// A warp that counts with how many active lanes it adds.
template <class W>
struct watched_warp : W {
    unsigned long long* counts;  ///< by number of lanes

    WARPAGG_HD void observe(const warpagg::mask_t<W>& active) const {
        unsigned long long* to = counts + warpagg::math::popcount(this->ballot(active));
        W::atomic(
            warpagg::operation::sum{}, [to](unsigned) { return to; }, warpagg::value_t<W, unsigned>(0u),
            warpagg::value_t<W, unsigned long long>(1), this->lane() == 0u);
    }
};

/// A backward blending on such a warp.
/// @{
template <class Kernel>
struct with_plain_adds : Kernel {
    template <class W>
    using scratch = typename Kernel::template scratch<plain_warp<W>>;
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index, scratch<W>& stage) const {
        Kernel::operator()(plain_warp<W>{w}, index, stage);
    }
};
template <class Kernel>
struct with_counts : Kernel {
    unsigned long long* counts;

    template <class W>
    using scratch = typename Kernel::template scratch<watched_warp<W>>;
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index, scratch<W>& stage) const {
        Kernel::operator()(watched_warp<W>{w, counts}, index, stage);
    }
};
/// @}

}  // namespace gs::lab
