// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "../tiles/tile_order.hpp"
#include "background.hpp"
#include "list_reader.hpp"

namespace gs::raster {

/// Blends each tile's list from front to back: C = sum_i c_i alpha_i T_i + T b with the
/// transmittance T_i = prod_(j < i) (1 - alpha_j) and the background b (Kerbl et al. 2023, equation
/// 3). One warp per patch. A pixel ends before the first splat that would reduce T below
/// `least_transmittance`.
template <class Real, class Cut, class Backdrop = constant_background<Real>>
struct blend_forward {
    tile_lists<Real> lists;
    tile_order order;
    Backdrop background;

    Real* render;               ///< three planes
    Real* transmittance;        ///< T behind the last splat of each pixel
    std::uint32_t* last;        ///< rank of the last splat of each pixel, from one; 0: none
    Real* checkpoints;          ///< by segment: see `checkpoint`
    unsigned long long* pairs;  ///< counter of evaluated pixel-Gaussian pairs

    static constexpr int warps_at_once = 24;  ///< warps per multiprocessor; measured

    template <class W>
    static std::size_t warps(std::size_t tiles) {
        return tiles * patch<W, Real, Cut>::per_tile;
    }
    template <class W>
    using scratch = splat_stage<W, Real>;
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp_index, splat_stage<W, Real>& stage) const {
        using real = value_t<W, Real>;
        constexpr unsigned rows = Cut::rows;
        using patch = raster::patch<W, Real, Cut>;
        const unsigned tile = order[warp_index / patch::per_tile], in_tile = warp_index % patch::per_tile;
        const patch p(w, tile, in_tile, lists.tiles_across, lists.width, lists.height);
        const tile_range range = lists.ranges[tile];

        real state[rows][4];  // T, negated when the pixel has ended, and the color so far
        value_t<W, unsigned> end[rows];
        for (unsigned k = 0; k < rows; ++k) {
            state[k][0] = select(p.inside[k], real(1), real(-1));
            state[k][1] = state[k][2] = state[k][3] = real(0);
            end[k] = value_t<W, unsigned>(0u);
        }
        unsigned walked = 0;
        const unsigned first = range.begin - range.begin % W::size;
        list_reader<W, Real, patch> reader(w, lists, p, range.begin, range.begin, range.end, stage, first,
                                           first + W::size);
        for (unsigned base = first; base < range.end; base += W::size) {
            mask_t<W> alive[rows];
            const std::uint32_t living =
                rows_with<Cut>(w, [&](unsigned k) { return alive[k] = state[k][0] > real(0); });
            if (Cut::sparse ? living == 0 : !w.any(any_of(alive))) break;
            if (base % Cut::segment == 0 && base > range.begin)
                for (unsigned k = 0; k < rows; ++k)
                    checkpoint<W, Real, patch>(checkpoints, tile + base / Cut::segment, in_tile)
                        .store(w, k, state[k]);
            const unsigned staged = reader.stage(w, base, base + W::size, base + 2 * W::size);
            walked += staged;
            for (unsigned i = 0; i < staged; ++i) {
                const staged_splat<Real>& s = stage.splats[i];
                const value_t<W, unsigned> rank(s.rank());
                const column_view<W, Real> seen = view_columns<W, Real>(s, p);
                real log2_alpha[rows];
                const std::uint32_t reached = rows_with<Cut>(w, [&](unsigned k) {
                    log2_alpha[k] = seen.log2_alpha(seen.v(p.y + Real(k * patch::block)));
                    return is_hit(log2_alpha[k]);
                });
                for_each_row<Cut>(reached & living, [&](unsigned k) {
                    const mask_t<W> hit = is_hit(log2_alpha[k]);
                    const real alpha = capped_alpha<W, Real>(log2_alpha[k]).alpha;
                    real& T = state[k][0];
                    const real behind = fma(-alpha, T, T);
                    const mask_t<W> counts = hit && behind >= real(Real(least_transmittance));
                    const real weight = select(counts, alpha, real(0)) * T;
                    state[k][1] = fma(weight, real(s.red), state[k][1]);
                    state[k][2] = fma(weight, real(s.green), state[k][2]);
                    state[k][3] = fma(weight, real(s.blue), state[k][3]);
                    // mutate: transmittance_from_total_alpha
                    T = select(counts, behind, select(hit, -warpagg::math::abs(T), T));
                    end[k] = select(counts, rank, end[k]);  // mutate: stop_not_remembered
                });
            }
        }
        write_pixels(w, p, state, end);
        add_pairs(w, walked * rows * W::size);
    }

  private:
    /// Writes the color, the transmittance and the last splat of each pixel.
    template <class W, class Patch>
    WARPAGG_HD void write_pixels(const W& w, const Patch& p, const value_t<W, Real> (&state)[Cut::rows][4],
                                 const value_t<W, unsigned> (&end)[Cut::rows]) const {
        using real = value_t<W, Real>;
        const auto plane = static_cast<unsigned>(lists.width * lists.height);
        for (unsigned k = 0; k < Cut::rows; ++k) {
            const auto pixel = p.pixel + k * p.step;
            const real T = warpagg::math::abs(state[k][0]);
            for (unsigned c = 0; c < 3; ++c)
                w.store(render, pixel + c * plane,
                        fma(T, background.at(w, pixel, c, plane, p.inside[k]), state[k][c + 1]), p.inside[k]);
            w.store(transmittance, pixel, T, p.inside[k]);
            w.store(last, pixel, end[k], p.inside[k]);
        }
    }

    template <class W>
    WARPAGG_HD void add_pairs(const W& w, unsigned evaluated) const {
        unsigned long long* to = pairs;
        w.atomic(
            warpagg::operation::sum{}, [to](unsigned) { return to; }, value_t<W, unsigned>(0u),
            value_t<W, unsigned long long>(evaluated), w.lane() == 0u);
    }
};

}  // namespace gs::raster
