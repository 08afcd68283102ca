// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "render/blend/blend_backward.hpp"

namespace gs::lab {

/// A contender: the lanes are the splats of a segment, and the pixels of the tile go past them, front to
/// back, each lane handing a pixel's state on to the next (as Taming-3DGS does it). Nothing is reduced: a
/// lane adds up its splat's sums and commits them once. For 32 lanes of scalars.
struct splat_per_lane {
    using cut = gs::raster::cut<8, 1, 32>;

    gs::raster::tile_lists<float> lists;
    gs::raster::blended<float> view;
    const std::uint32_t* tile_of_segment;
    float* sums;

    template <class W>
    static std::size_t warps(std::size_t, std::size_t segments) {
        return segments;
    }
    template <class W>
    static std::size_t warps_of_sum(std::size_t tiles) {
        return tiles;
    }

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned segment) const {
        using namespace gs::raster;
        static_assert(W::size == 32);
        constexpr unsigned pixels = tile_size * tile_size;
        const std::uint32_t after = tile_of_segment[segment];
        if (after == 0) return;
        const unsigned tile = after - 1;
        const tile_range range = lists.ranges[tile];
        const unsigned first = (segment - tile) * cut::segment, place = first + w.lane();
        const bool mine = place >= range.begin && place < range.end;
        const bool from_front = first <= range.begin;
        const std::uint32_t gaussian = mine ? lists.gaussian_of[place] : 0;
        const splat<float> s = mine ? lists.splats[gaussian] : splat<float>{};
        const auto plane = static_cast<unsigned>(lists.width * lists.height);
        const unsigned x0 = tile % lists.tiles_across * tile_size, y0 = tile / lists.tiles_across * tile_size;

        // Like a splat on the stage: see `list_reader`.
        const float dx = static_cast<float>(x0) + 0.5f - s.x, dy = static_cast<float>(y0) + 0.5f - s.y;
        const staged_splat<float> staged{s.p,    s.p * dx,
                                         s.r,    warpagg::math::fma(s.q, dy, s.r * dx),
                                         s.q,    s.log2_opacity,
                                         s.red,  s.green,
                                         s.blue, 0,
                                         0,      0};
        float sum[sum_count] = {};
        float T = 0, rest = 0;  // of the pixel that is at this lane: rest is g (C - color so far)
        for (unsigned step = 0; step < pixels + 31; ++step) {
            T = w.shfl(T, (w.lane() + 31) % 32);
            rest = w.shfl(rest, (w.lane() + 31) % 32);
            const unsigned at = step - w.lane();  // wraps around before the first
            const unsigned x = x0 + at % tile_size, y = y0 + at / tile_size;
            if (at >= pixels || x >= static_cast<unsigned>(lists.width) ||
                y >= static_cast<unsigned>(lists.height))
                continue;
            const unsigned pixel = y * static_cast<unsigned>(lists.width) + x;
            float g[3];
            for (unsigned c = 0; c < 3; ++c) g[c] = view.gradient[pixel + c * plane];
            if (w.lane() == 0) {
                // See `patch` and `checkpoint` for where a pixel's state lies.
                const unsigned in_tile = at / tile_size / 4 * 2 + at % tile_size / 8;
                const unsigned lane = at / tile_size % 4 * 8 + at % 8;
                const float* state = view.checkpoints + segment * checkpoint_values + in_tile * 128 + lane;
                T = from_front ? 1.0f : state[0];
                rest = 0;
                for (unsigned c = 0; c < 3; ++c)
                    rest +=
                        g[c] * (view.render[pixel + c * plane] - (from_front ? 0.0f : state[32 * (c + 1)]));
            }
            const bool live = mine && place - range.begin < view.last[pixel];
            const column_view<W, float> seen(staged, static_cast<float>(at % tile_size));
            const float v = seen.v(static_cast<float>(at / tile_size)), log2_alpha = seen.log2_alpha(v);
            if (!live || !is_hit(log2_alpha)) continue;
            const capped_alpha<W, float> capped(log2_alpha);
            const float weight = capped.alpha * T, own = g[0] * s.red + g[1] * s.green + g[2] * s.blue;
            rest -= weight * own;
            const float by_alpha = T * own - warpagg::math::divide(rest, 1 - capped.alpha);
            const float ds = capped.free ? capped.alpha * by_alpha : 0.0f;
            T = warpagg::math::fma(-capped.alpha, T, T);
            sum[sum_red] += weight * g[0];
            sum[sum_green] += weight * g[1];
            sum[sum_blue] += weight * g[2];
            sum[sum_s] += ds;
            sum[sum_su] += ds * seen.u;
            sum[sum_sv] += ds * v;
            sum[sum_suu] += ds * seen.u * seen.u;
            sum[sum_suv] += ds * seen.u * v;
            sum[sum_svv] += ds * v * v;
        }
        float* to = sums + gaussian * record_stride;
        for (unsigned i = 0; i < sum_count; ++i)
            w.atomic(
                warpagg::operation::sum{}, [to](unsigned k) { return to + k; }, i, sum[i],
                mine && sum[i] != 0);
    }
};

}  // namespace gs::lab
