// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../simt/warp.hpp"

namespace warpagg::reduce {

/// Sums each of the N values over the warp by `__shfl_down_sync` with halved distances (the paper, Figure 1).
/// Lane 0 holds the sums afterwards. Cost: N log2(W) shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class V, int N>
WARPAGG_HD void sum_shfl_down(const W& w, V (&v)[N]) {
    for (unsigned distance = W::size / 2; distance > 0; distance /= 2)
        for (int i = 0; i < N; ++i) v[i] += w.shfl_down(v[i], distance);
}

/// The same tree, to every lane. Cost: N log2(W) shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class V, int N>
WARPAGG_HD void sum_butterfly(const W& w, V (&v)[N]) {
    for (unsigned distance = W::size / 2; distance > 0; distance /= 2)
        for (int i = 0; i < N; ++i) v[i] += w.shfl_xor(v[i], distance);
}

}  // namespace warpagg::reduce
