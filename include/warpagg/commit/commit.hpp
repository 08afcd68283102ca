// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../simt/warp.hpp"

namespace warpagg::commit {

/// Every active lane adds its own values: N atomics a lane.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, class V, int N>
WARPAGG_HD void each_lane(const W& w, Dst dst, const V (&v)[N], const mask_t<W>& active) {
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        w.atomic_add(dst, value_t<W, unsigned>(static_cast<unsigned>(i)), v[i], active);
}

/// Lane 0 adds its values: N atomics.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, class V, int N>
WARPAGG_HD void first_lane(const W& w, Dst dst, const V (&v)[N]) {
    each_lane(w, dst, v, w.lane() == 0u);
}

/// Lane i adds its value v[i], which is the same in all lanes: one atomic instruction for W values.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, class V, int N>
WARPAGG_HD void own_value(const W& w, Dst dst, const V (&v)[N]) {
    using math::select;
    WARPAGG_UNROLL
    for (int base = 0; base < N; base += static_cast<int>(W::size)) {
        const auto index = w.lane() + static_cast<unsigned>(base);
        V own = v[base];
        for (int i = base + 1; i < N && i < base + static_cast<int>(W::size); ++i)
            own = select(index == static_cast<unsigned>(i), v[i], own);
        w.atomic_add(dst, index, own, index < static_cast<unsigned>(N));
    }
}

}  // namespace warpagg::commit
