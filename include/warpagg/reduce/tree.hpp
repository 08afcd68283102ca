// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../simt/warp.hpp"

namespace warpagg::reduce {

/// Sums each of the N values over the warp by `__shfl_down_sync` with halved distances (the paper, Figure 1).
/// Lane 0 holds the sums afterwards. Cost: N log2(W) shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, warp W, class V, int N>
WARPAGG_HD void sum_shfl_down_from(const W& w, V (&v)[N]) {
    if constexpr (Distance > 0) {
        WARPAGG_UNROLL
        for (int i = 0; i < N; ++i) v[i] += w.shfl_down(v[i], Distance);
        sum_shfl_down_from<Distance / 2>(w, v);
    }
}
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class V, int N>
WARPAGG_HD void sum_shfl_down(const W& w, V (&v)[N]) {
    sum_shfl_down_from<W::size / 2>(w, v);
}

/// The same tree, to every lane. Cost: N log2(W) shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, warp W, class V, int N>
WARPAGG_HD void sum_butterfly_from(const W& w, V (&v)[N]) {
    if constexpr (Distance > 0) {
        WARPAGG_UNROLL
        for (int i = 0; i < N; ++i) v[i] += w.shfl_xor(v[i], Distance);
        sum_butterfly_from<Distance / 2>(w, v);
    }
}
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class V, int N>
WARPAGG_HD void sum_butterfly(const W& w, V (&v)[N]) {
    sum_butterfly_from<W::size / 2>(w, v);
}

}  // namespace warpagg::reduce
