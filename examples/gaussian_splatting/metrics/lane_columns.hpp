// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "ssim_window.hpp"

namespace gs::train {

/// Consecutive values of a row in the registers of a warp: lane l holds `Columns` neighbors, which
/// begin with value `Columns * l`. Lanes get the values to their right by shuffles.
template <class W, class Real, int Columns>
struct lane_columns {
    using real = value_t<W, Real>;
    using number = value_t<W, unsigned>;
    static constexpr int window = ssim_window<Real>::size;
    /// The number of values under the windows that begin with a lane's values.
    static constexpr int reach = Columns + window - 1;
    static_assert(window - 1 <= static_cast<int>(W::size));

    real at[Columns];

    /// Copies the values under the windows that begin with a lane's values. Undefined in the last
    /// lanes, unless all of these values belong to the row. Cost: window - 1 shuffles.
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD void under_windows(const W& w, real (&values)[reach]) const {
        WARPAGG_UNROLL
        for (int i = 0; i < reach; ++i)
            values[i] =
                i < Columns ? at[i] : w.shfl_down(at[i % Columns], static_cast<unsigned>(i / Columns));
    }
    /// The same in all lanes. `after` holds the window - 1 values behind those of the last lane, one
    /// per lane. Costs as many selections more.
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD void under_windows(const W& w, const real& after, real (&values)[reach]) const {
        const number lane = w.lane(), last(W::size - 1);
        real next[Columns];  // the values of the lane as many lanes further as the warp has
        WARPAGG_UNROLL
        for (int c = 0; c < Columns; ++c)
            next[c] = w.shfl(after, (lane * number(Columns) + number(static_cast<unsigned>(c))) & last);
        WARPAGG_UNROLL
        for (int i = 0; i < Columns; ++i) values[i] = at[i];
        WARPAGG_UNROLL
        for (int i = Columns; i < reach; ++i) {
            const int c = i % Columns;
            const number distance(static_cast<unsigned>(i / Columns));
            values[i] = w.shfl(select(lane < distance, next[c], at[c]), (lane + distance) & last);
        }
    }
};

/// Reads values of `lane_columns::under_windows` for `ssim_window`: N maps, under the window that
/// begins at `column`.
template <class V, int N, int Reach>
struct lane_values {
    const V (&values)[N][Reach];
    int column;

    WARPAGG_HD V operator()(int map, int tap) const {
        return values[map][column + ssim_window<float>::radius + tap];
    }
};

}  // namespace gs::train
