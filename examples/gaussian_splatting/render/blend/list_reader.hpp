// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/bits.hpp"
#include "../geometry/panorama.hpp"
#include "patch.hpp"

namespace gs::raster {

/// A splat relative to a tile. For the pixel (x, y) of the tile, u = p x + u0 and
/// v = q y + r x + v0: see `whitened`. In a panorama, u = p dx and v = q y + r dx + v0 with the
/// `nearest_offset` dx of x + u0.
template <class Real>
struct alignas(16) staged_splat {
    Real p, u0, r, v0;
    Real q, log2_opacity, red, green;
    Real blue;
    Real rank_bits, gaussian_bits;  ///< integers, stored as the bits of `Real`
    Real unused;

    /// Returns the position in the tile's list, counted from one.
    WARPAGG_HD unsigned rank() const { return static_cast<unsigned>(bits_of<bits_as<Real>>(rank_bits)); }
    WARPAGG_HD unsigned gaussian() const {
        return static_cast<unsigned>(bits_of<bits_as<Real>>(gaussian_bits));
    }
};

/// The parts of a splat's exponent that all pixels of a column share. One column per lane.
template <class W, class Real>
struct column_view {
    using real = value_t<W, Real>;
    real u;

    WARPAGG_HD column_view(const staged_splat<Real>& s, const real& x)
        : u(fma(real(s.p), x, real(s.u0))),
          left_(fma(-u, u, real(s.log2_opacity))),
          shear_(fma(real(s.r), x, real(s.v0))),
          q_(s.q) {}

    /// In a panorama of this width.
    WARPAGG_HD column_view(const staged_splat<Real>& s, const real& x, const real& width) : q_(s.q) {
        const real dx = nearest_offset(x + real(s.u0), width);
        u = real(s.p) * dx;
        left_ = fma(-u, u, real(s.log2_opacity));
        shear_ = fma(real(s.r), dx, real(s.v0));
    }

    WARPAGG_HD real v(const real& y) const { return fma(q_, y, shear_); }
    /// Returns log2 of alpha before the cap. Explicit `fma` fixes the rounding, so that the forward
    /// and the backward pass get the same bits.
    WARPAGG_HD real log2_alpha(const real& v) const { return fma(-v, v, left_); }

  private:
    real left_, shear_, q_;
};

/// Returns what the pixels of a patch see of a splat.
template <class W, class Real, class Patch>
WARPAGG_HD column_view<W, Real> view_columns(const staged_splat<Real>& s, const Patch& p) {
    if constexpr (Patch::panorama)
        return {s, p.x, value_t<W, Real>(p.image_width)};
    else
        return {s, p.x};
}

/// The splats that a warp blends next, in memory that its lanes share.
template <class W, class Real>
struct splat_stage {
    staged_splat<Real> splats[W::size];
};

/// Reads a tile's list in blocks of W::size places, and stages the splats that may reach a patch.
/// It loads the next block while the warp blends the staged one, which hides the latency of memory.
template <class W, class Real, class Patch>
class list_reader {
    using real = value_t<W, Real>;
    using index = value_t<W, unsigned>;

    static_assert(W::size <= 32, "the rasterizer keeps the bits of a warp's lanes in 32 bits");

  public:
    /// Reads the places [from, to) of a tile's list, which begins at `begin`. The first block
    /// begins at `base`, and the second one at `next`.
    WARPAGG_HD list_reader(const W& w, const tile_lists<Real>& lists, const Patch& p, unsigned begin,
                           unsigned from, unsigned to, splat_stage<W, Real>& stage, unsigned base,
                           unsigned next)
        : lists_(lists), patch_(p), begin_(begin), from_(from), to_(to), stage_(stage) {
        waiting_ = load_gaussians(w, base);
        fetch(w, base, next);
    }

    /// Stages the block at `base`, which was fetched last, and fetches the block at `next`. `after`
    /// is the beginning of the block after that. Returns the number of staged splats, which keep
    /// the order of the list.
    WARPAGG_HD unsigned stage(const W& w, unsigned base, unsigned next, unsigned after) {
        const real least = least_exponent_in_patch();
        // The test of single pixels decides. The slack keeps splats that only rounding would drop.
        constexpr Real slack = Real(1) / 256;
        const mask_t<W> reaches = is_valid(w, base) && least <= field_[7] + slack;
        const std::uint32_t hits = w.ballot(reaches);
        if (hits != 0) {
            const real dx = patch_.tile_left - field_[0], dy = patch_.tile_top - field_[1];
            const auto &p = field_[2], &q = field_[3], &r = field_[4];
            const auto bits = [](const index& i) {
                return bits_of<real>(warpagg::math::convert<bits_as<Real>>(i));
            };
            const index rank = w.lane() + (base + 1 - begin_);
            // knob: stage_splat
            const real u0 = Patch::panorama ? dx : p * dx;
            const real v0 = Patch::panorama ? q * dy : fma(q, dy, r * dx);
            const real staged[12] = {p,
                                     u0,
                                     r,
                                     v0,
                                     q,
                                     field_[8],
                                     field_[9],
                                     field_[10],
                                     field_[11],
                                     bits(rank),
                                     bits(gaussian_),
                                     real(0)};
            const index slot = warpagg::math::popcount(lanes_below(w) & index(hits));
            w.sync();  // all lanes have read the previous splats
            w.store_packed(reinterpret_cast<Real*>(stage_.splats), slot * 12u, staged, reaches);
            w.sync();
        }
        fetch(w, next, after);
        return warpagg::math::popcount(hits);
    }

  private:
    WARPAGG_HD real least_exponent_in_patch() const {
        const real x0 = patch_.left - field_[0], y0 = patch_.top - field_[1];
        const real x1 = x0 + Real(Patch::across - 1), y1 = y0 + Real(Patch::down - 1);
        if constexpr (Patch::panorama)
            return least_exponent_around<real>(field_[2], field_[3], field_[4], field_[5], field_[6], x0, x1,
                                               y0, y1, real(patch_.image_width));
        else
            return least_exponent<real>(field_[2], field_[3], field_[4], field_[5], field_[6], x0, x1, y0,
                                        y1);
    }
    WARPAGG_HD mask_t<W> is_valid(const W& w, unsigned base) const {
        const index place = w.lane() + base;
        return place >= from_ && place < to_;
    }
    WARPAGG_HD index load_gaussians(const W& w, unsigned base) const {
        return w.load(lists_.gaussian_of, w.lane() + base, is_valid(w, base));
    }
    WARPAGG_HD void fetch(const W& w, unsigned base, unsigned next) {
        gaussian_ = waiting_;
        w.load_packed(reinterpret_cast<const Real*>(lists_.splats), gaussian_ * splat_width, field_,
                      is_valid(w, base));
        waiting_ = load_gaussians(w, next);
    }
    static WARPAGG_HD index lanes_below(const W& w) { return (index(1u) << w.lane()) - 1u; }

    const tile_lists<Real>& lists_;
    const Patch& patch_;
    unsigned begin_, from_, to_;
    splat_stage<W, Real>& stage_;
    real field_[splat_width];   // values of the fetched splats
    index gaussian_, waiting_;  // indices of the fetched Gaussians, and of those in the next block
};

}  // namespace gs::raster
