// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "bits.hpp"
#include "patch.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// The gradient of `blend_forward`: back to front over what each pixel saw, T recovered by division, nine
/// sums a Gaussian (see `sum`) handed to `warp_reduce_atomic` with `Policy`. With g = dL/dC and B_i the
/// colour behind splat i per unit of transmittance, background included, dL/dalpha_i = T_i g (c_i - B_i): one
/// scalar g B is carried instead of three channels, and nothing is divided by 1 - alpha but T. `AskFirst`:
/// skip what no pixel of the patch sees before any of it is computed (the paper, Figure 8).
template <class Real, class Policy, bool AskFirst>
struct blend_backward {
    const splat<Real>* splats;
    const std::uint32_t* gaussian_of;
    const tile_range* ranges;
    unsigned tiles_across;
    int width, height;
    glm::vec<3, Real> background;
    const Real* transmittance;
    const std::uint32_t* last;
    const Real* gradient;  ///< dL/dC: three planes

    Real* sums;  ///< `record_stride` a Gaussian, added to

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        using real = value_t<W, Real>;
        const patch<W, Real> p(w, warp_index, tiles_across, width, height);
        const tile_range range = ranges[p.tile];
        const auto plane = static_cast<unsigned>(width * height);

        const real g0 = w.load(gradient, p.pixel, p.inside);
        const real g1 = w.load(gradient, p.pixel + plane, p.inside);
        const real g2 = w.load(gradient, p.pixel + 2 * plane, p.inside);
        real T = w.load(transmittance, p.pixel, p.inside);
        real behind = g0 * background[0] + g1 * background[1] + g2 * background[2];
        const value_t<W, unsigned> end = w.load(last, p.pixel, p.inside);

        const unsigned length = range.end - range.begin;
        for (unsigned batch = (length + W::size - 1) / W::size; batch-- > 0;) {
            const unsigned base = range.begin + batch * W::size;
            if (!w.any(end > batch * W::size)) continue;
            std::uint32_t hits = p.reached_by(w, splats, gaussian_of, base, range.end);
            while (hits != 0) {
                const unsigned bit = highest_bit(hits);
                hits ^= 1u << bit;
                const std::uint32_t gaussian = gaussian_of[base + bit];
                const splat<Real>& s = splats[gaussian];
                const coverage<W, Real> seen(s, p);
                const mask_t<W> counts = seen.hit && end > batch * W::size + bit;
                if constexpr (AskFirst) {
                    if (warpagg::skip_if_warp_idle(w, counts)) continue;
                }

                T = select(counts, T / (Real(1) - seen.alpha), T);
                const real weight = seen.alpha * T;
                const real own = g0 * s.red + g1 * s.green + g2 * s.blue;
                const real ds = select(seen.free, weight * (own - behind), real(0));
                behind = select(counts, fma(seen.alpha, own - behind, behind), behind);
                const real dsu = ds * seen.at.u, dsv = ds * seen.at.v;
                real values[sum_count];
                values[sum_red] = weight * g0;
                values[sum_green] = weight * g1;
                values[sum_blue] = weight * g2;
                values[sum_s] = ds;
                values[sum_su] = dsu;
                values[sum_sv] = dsv;
                values[sum_suu] = dsu * seen.at.u;
                values[sum_suv] = dsu * seen.at.v;
                values[sum_svv] = dsv * seen.at.v;
                warpagg::warp_reduce_atomic(w, sums + gaussian * record_stride, values, counts, Policy{});
            }
        }
    }
};

}  // namespace gs::raster
