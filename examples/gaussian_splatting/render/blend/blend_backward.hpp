// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <warpagg/atomic.hpp>

#include "../project/project_backward.hpp"
#include "background.hpp"
#include "list_reader.hpp"

namespace gs::raster {

/// The type of a gradient sum in memory: an accumulator if the policy names one, `Real` otherwise.
/// @{
template <class Real, class Policy>
struct sum_of {
    using type = Real;
};
template <class Real, class Policy>
requires requires { typename Policy::accumulate::storage; }
struct sum_of<Real, Policy> {
    using type = warpagg::accumulator<typename Policy::accumulate::storage>;
};
template <class Real, class Policy>
using sum_in_memory = typename sum_of<Real, Policy>::type;
/// @}

/// The inputs of the backward pass besides the tile lists: results of the forward pass, and the
/// gradient of the loss.
template <class Real, class Backdrop = constant_background<Real>>
struct blended {
    Backdrop background;
    const Real* render;         ///< three planes
    const Real* transmittance;  ///< this and the next two: see `blend_forward`
    const std::uint32_t* last;
    Real* checkpoints;
    const Real* gradient;  ///< dL/dimage: three planes
};

/// Computes the gradient of `blend_forward`. Each pixel walks back to front over the splats that it
/// saw and recovers the transmittance T by division. Nine sums per Gaussian (see `sum`) are added
/// to memory by `warp_reduce_atomic` with `Policy`.
///
/// Let g = dL/dC, and let B_i be the color behind splat i per unit of transmittance, background
/// included. Then dL/dalpha_i = T_i g (c_i - B_i). So a pixel carries the scalar g B instead of
/// three channels, and only T is divided by 1 - alpha. The pixels of a lane lie in one column and
/// share u, which is multiplied into the sums once.
///
/// `Split`: one warp per patch and segment; otherwise one warp per patch. `AskFirst`: skips splats
/// that no pixel of the patch sees before anything is computed (the paper, Figure 8).
template <class Real, class Cut, bool Split, class Policy, bool AskFirst,
          class Backdrop = constant_background<Real>>
struct blend_backward {
    using policy = Policy;

    tile_lists<Real> lists;
    blended<Real, Backdrop> view;
    const std::uint32_t* tile_of_segment;  ///< see `number_segments`

    sum_in_memory<Real, Policy>* sums;  ///< `record_stride` per Gaussian; the kernel adds to them
    Policy how;                         // knob: backward_policy

    static constexpr int warps_at_once = 32;  ///< warps per multiprocessor; measured

    template <class W>
    static std::size_t warps(std::size_t tiles, std::size_t segments) {
        return (Split ? segments : tiles) * patch<W, Real, Cut>::per_tile;
    }
    /// Returns the largest number of warps that add to the sums of one Gaussian, which is in the
    /// list of each tile at most once.
    template <class W>
    static std::size_t warps_of_sum(std::size_t tiles) {
        return tiles * patch<W, Real, Cut>::per_tile;
    }
    template <class W>
    using scratch = splat_stage<W, Real>;
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp_index, splat_stage<W, Real>& stage) const {
        using patch = raster::patch<W, Real, Cut>;
        const unsigned unit = warp_index / patch::per_tile, in_tile = warp_index % patch::per_tile;
        if constexpr (Split) {
            const std::uint32_t after = tile_of_segment[unit];
            if (after == 0) return;
            const std::uint32_t tile = after - 1;
            const tile_range r = lists.ranges[tile];
            const unsigned first = (unit - tile) * Cut::segment;
            walk<W, patch>(w, stage, tile, in_tile, r.begin, warpagg::math::max(r.begin, first),
                           warpagg::math::min(r.end, first + Cut::segment));
        } else {
            const tile_range r = lists.ranges[unit];
            walk<W, patch>(w, stage, unit, in_tile, r.begin, r.begin, r.end);
        }
    }

  private:
    /// The state of a pixel during the walk: g, the transmittance T in front of the last walked
    /// splat, and `behind`, which is g B.
    template <class real>
    struct pixel_state {
        real g[3];
        real T, behind;
    };

    /// Walks over the places [from, to) of a tile's list, which begins at `begin`, from back to
    /// front.
    template <class W, class Patch>
    WARPAGG_HD void walk(const W& w, splat_stage<W, Real>& stage, unsigned tile, unsigned in_tile,
                         unsigned begin, unsigned from, unsigned to) const {
        using real = value_t<W, Real>;
        constexpr unsigned rows = Cut::rows;
        const Patch p(w, tile, in_tile, lists.tiles_across, lists.width, lists.height);
        value_t<W, unsigned> end[rows];  // the rank of the last splat that counted
        mask_t<W> lives[rows];
        for (unsigned k = 0; k < rows; ++k) end[k] = w.load(view.last, p.pixel + k * p.step, p.inside[k]);
        const auto some_pass = [&](unsigned place) {
            for (unsigned k = 0; k < rows; ++k) lives[k] = end[k] > place - begin;
            return w.any(any_of(lives));
        };
        if (!some_pass(from)) return;
        pixel_state<real> pixels[rows];
        begin_pixels(w, p, tile, in_tile, to - begin, to / Cut::segment, end, pixels);

        // Skips blocks behind the last splat that counted for any pixel.
        unsigned base = (to - 1) - (to - 1) % W::size;
        while (base > from && !some_pass(base)) base -= W::size;
        list_reader<W, Real, Patch> reader(w, lists, p, begin, from, to, stage, base, base - W::size);
        for (;; base -= W::size) {
            const unsigned staged = reader.stage(w, base, base - W::size, base - 2 * W::size);
            // Prefetches the sums if one thread runs all lanes and would wait for each splat's.
            if constexpr (!std::is_same_v<mask_t<W>, bool>)
                for (unsigned i = 0; i < staged; ++i)
                    __builtin_prefetch(sums + stage.splats[i].gaussian() * record_stride, 1);
            // knob: add_splats
            for (unsigned i = staged; i-- > 0;) add_splat(w, p, stage.splats[i], end, pixels);
            if (base <= from) break;
        }
    }

    /// Sets the pixels to their state behind the splat of rank `to`. Pixels with later splats
    /// continue from the checkpoint of segment `tile + next`.
    template <class W, class Patch, class real, class ends>
    WARPAGG_HD void begin_pixels(const W& w, const Patch& p, unsigned tile, unsigned in_tile, unsigned to,
                                 unsigned next, const ends& end,
                                 pixel_state<real> (&pixels)[Cut::rows]) const {
        const auto plane = static_cast<unsigned>(lists.width * lists.height);
        for (unsigned k = 0; k < Cut::rows; ++k) {
            const auto at = p.pixel + k * p.step;
            auto& [g, T, behind] = pixels[k];
            for (unsigned c = 0; c < 3; ++c) g[c] = w.load(view.gradient, at + c * plane, p.inside[k]);
            T = w.load(view.transmittance, at, p.inside[k]);
            const auto back = [&](unsigned c) { return view.background.at(w, at, c, plane, p.inside[k]); };
            behind = g[0] * back(0) + g[1] * back(1) + g[2] * back(2);
            if constexpr (Split) {
                const mask_t<W> later = end[k] > to;
                if (!w.any(later)) continue;
                real front[4];
                checkpoint<W, Real, Patch>(view.checkpoints, tile + next, in_tile).load(w, k, front);
                real rest(0);
                for (unsigned c = 0; c < 3; ++c)
                    rest = fma(g[c], w.load(view.render, at + c * plane, p.inside[k]) - front[c + 1], rest);
                T = select(later, front[0], T);
                behind = select(later, rest / front[0], behind);
            }
        }
    }

    template <class W, class Patch, class real, class ends>
    WARPAGG_HD void add_splat(const W& w, const Patch& p, const staged_splat<Real>& s, const ends& end,
                              pixel_state<real> (&pixels)[Cut::rows]) const {  // knob: add_splat
        constexpr unsigned rows = Cut::rows;
        const unsigned rank = s.rank();
        const unsigned record = s.gaussian() * record_stride;
        const column_view<W, Real> seen = view_columns<W, Real>(s, p);
        real v[rows], log2_alpha[rows];
        mask_t<W> counts[rows];
        const std::uint32_t reached = rows_with<Cut>(w, [&](unsigned k) {
            v[k] = seen.v(p.y + Real(k * Patch::block));
            log2_alpha[k] = seen.log2_alpha(v[k]);  // mutate: alpha_rounded_otherwise_backward
            return counts[k] = is_hit(log2_alpha[k]) && end[k] >= rank;  // mutate: skipped_splats_divided_out
        });
        if constexpr (Cut::sparse) {
            if (reached == 0) return;
        } else if constexpr (AskFirst) {
            if (warpagg::skip_if_warp_idle(w, any_of(counts))) return;
        }

        // Sums over the pixels of the lane: red, green, blue, s, s v, s v^2.
        real part[6];
        for (real& x : part) x = real(0);
        for_each_row<Cut>(reached, [&](unsigned k) {
            auto& [g, T, behind] = pixels[k];
            const capped_alpha<W, Real> capped(log2_alpha[k]);
            // mutate: alpha_cap_differs_backward
            const real alpha = select(counts[k], capped.alpha, real(0));
            T = warpagg::math::divide(T, Real(1) - alpha);
            const real weight = alpha * T;
            const real own = fma(g[0], real(s.red), fma(g[1], real(s.green), g[2] * s.blue));
            // mutate: gradient_through_the_cap
            const real ds = select(capped.free, weight * (own - behind), real(0));
            behind = fma(alpha, own - behind, behind);
            const real dsv = ds * v[k];
            const real terms[] = {weight * g[0], weight * g[1], weight * g[2], ds, dsv, dsv * v[k]};
            WARPAGG_UNROLL
            for (unsigned i = 0; i < 6; ++i) part[i] = !Cut::sparse && k == 0 ? terms[i] : part[i] + terms[i];
        });
        real values[sum_count];
        values[sum_red] = part[0];
        values[sum_green] = part[1];
        values[sum_blue] = part[2];
        values[sum_s] = part[3];
        values[sum_su] = seen.u * part[3];
        values[sum_sv] = part[4];
        values[sum_suu] = seen.u * values[sum_su];
        values[sum_suv] = seen.u * part[4];
        values[sum_svv] = part[5];
        // knob: pad_gradients
        // With several pixels per lane, alpha is zero where the splat does not count, so that all
        // lanes can take part.
        const mask_t<W> who = rows > 1 ? mask_t<W>(true) : counts[0];
        const auto to = [this, record](unsigned i) { return sums + (record + i); };
        warpagg::warp_reduce_atomic(w, to, values, who, how);  // knob: add_to_sums
    }
};

}  // namespace gs::raster
