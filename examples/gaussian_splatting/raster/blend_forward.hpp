// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "patch.hpp"

namespace gs::raster {

/// Front to back over each tile's list: C = sum c_i alpha_i T_i + T b, T_i = prod (1 - alpha_j) (Kerbl et al.
/// 2023, equation 3). One warp a patch. A pixel ends where a splat would bring T below `least_transmittance`.
template <class Real>
struct blend_forward {
    const splat<Real>* splats;
    const std::uint32_t* gaussian_of;
    const tile_range* ranges;
    unsigned tiles_across;
    int width, height;
    glm::vec<3, Real> background;

    Real* picture;              ///< three planes
    Real* transmittance;        ///< what is left behind the last splat
    std::uint32_t* last;        ///< one past the place, in the tile's list, of the last splat that counted
    unsigned long long* pairs;  ///< pixel-Gaussian pairs that were evaluated, added to

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        using real = value_t<W, Real>;
        const patch<W, Real> p(w, warp_index, tiles_across, width, height);
        const tile_range range = ranges[p.tile];

        real T(1), red(0), green(0), blue(0);
        value_t<W, unsigned> end(0u);
        mask_t<W> alive = p.inside;
        unsigned walked = 0;
        for (unsigned base = range.begin; base < range.end && w.any(alive); base += W::size) {
            std::uint32_t hits = p.reached_by(w, splats, gaussian_of, base, range.end);
            for (; hits != 0; hits &= hits - 1, ++walked) {
                const unsigned place = base + warpagg::math::countr_zero(hits);
                const splat<Real>& s = splats[gaussian_of[place]];
                const coverage<W, Real> seen(s, p);
                const real behind = T * (Real(1) - seen.alpha);
                const mask_t<W> reaches = alive && seen.hit;
                const mask_t<W> ends = reaches && behind < real(Real(least_transmittance));
                const mask_t<W> counts = reaches && !ends;
                const real weight = select(counts, seen.alpha * T, real(0));
                red = fma(weight, real(s.red), red);
                green = fma(weight, real(s.green), green);
                blue = fma(weight, real(s.blue), blue);
                T = select(counts, behind, T);
                end = select(counts, value_t<W, unsigned>(place + 1 - range.begin), end);
                alive = alive && !ends;
            }
        }

        const auto plane = static_cast<unsigned>(width * height);
        w.store(picture, p.pixel, fma(T, real(background[0]), red), p.inside);
        w.store(picture, p.pixel + plane, fma(T, real(background[1]), green), p.inside);
        w.store(picture, p.pixel + 2 * plane, fma(T, real(background[2]), blue), p.inside);
        w.store(transmittance, p.pixel, T, p.inside);
        w.store(last, p.pixel, end, p.inside);
        add_pairs(w, walked);
    }

  private:
    template <class W>
    WARPAGG_HD void add_pairs(const W& w, unsigned walked) const {
        unsigned long long* to = pairs;
        w.atomic(
            warpagg::operation::sum{}, [to](unsigned) { return to; }, value_t<W, unsigned>(0u),
            value_t<W, unsigned long long>(static_cast<unsigned long long>(walked) * W::size),
            w.lane() == 0u);
    }
};

}  // namespace gs::raster
