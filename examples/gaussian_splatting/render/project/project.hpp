// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../core/bits.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../geometry/effect_set.hpp"
#include "../geometry/splat.hpp"
#include "../tiles/tile_reach.hpp"
#include "antialiasing.hpp"
#include "dropout.hpp"
#include "gaussian_row.hpp"
#include "geometry.hpp"

namespace gs::raster {

/// Projects Gaussians to splats. One Gaussian per lane.
template <class W, class Real, effect_set Effects>
struct project {
    using real = value_t<W, Real>;
    using number = value_t<W, std::uint32_t>;

    parameter_arrays<const Real> gaussians;
    std::size_t count;
    camera_type<real, Effects> camera;
    int sh_degree;
    unsigned tiles_across, tiles_down;

    splat<Real>* splats;
    tile_box* boxes;
    std::uint32_t* depths;      ///< sort keys: the bits of positive floats have their order
    std::uint32_t* identities;  ///< index of each Gaussian, sorted along with the key
    std::uint32_t* tiles;       ///< number of tiles in the splat's box; zero if it is not drawn
    raster::dropout dropout = {};

    static std::size_t warps(std::size_t count) { return (count + W::size - 1) / W::size; }

    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        const number i = w.lane() + warp_index * W::size;
        const mask_t<W> inside = i < number(static_cast<std::uint32_t>(count));
        gaussian_row<W> row{std::size_t{warp_index} * W::size, inside, inside};
        const vec3<real> mean = row.template load<3>(w, gaussians.mean, 0, 3);
        const vec3<real> at = in_camera(mean, camera);
        row.active = inside && projection_of<real, Effects>::is_drawn(at, camera);
        if (dropout.limit != 0) row.active = row.active && !dropout.leaves_out(i);
        drawing d{};
        if (w.any(row.active)) draw(w, row, mean, at, d);

        const auto first = static_cast<std::ptrdiff_t>(row.first);
        const auto drawn = [&]<class V>(const V& value) { return select(row.active, value, V(0)); };
        const auto depth = warpagg::math::convert<float>(projection_of<real, Effects>::depth(at));
        w.store_row(identities, first, i, inside);
        w.store_row(depths, first, select(row.active, bits_of<number>(depth), number(0xffffffffu)), inside);
        // mutate: keys_of_the_culled_left_as_they_are
        w.store_row(tiles, first, drawn((d.x1 - d.x0) * (d.y1 - d.y0)), inside);
        // A `tile_box` as two words of 32 bits.
        auto* corners = reinterpret_cast<std::uint32_t*>(boxes);
        w.store(corners, 2 * i, drawn(d.x0 | d.y0 << number(16u)), inside);
        w.store(corners, 2 * i + 1, drawn(d.x1 | d.y1 << number(16u)), inside);
        const splat<real>& s = d.shape;
        const real values[splat_width] = {drawn(s.x),         drawn(s.y),      drawn(s.p),
                                          drawn(s.q),         drawn(s.r),      drawn(s.dx_per_dy),
                                          drawn(s.dy_per_dx), drawn(s.cutoff), drawn(s.log2_opacity),
                                          drawn(s.red),       drawn(s.green),  drawn(s.blue)};
        w.store_packed(reinterpret_cast<Real*>(splats), i * splat_width, values, inside);
    }

  private:
    struct drawing {
        splat<real> shape;
        number x0, y0, x1, y1;  ///< its `tile_box`
    };

    /// Computes the splats of the active Gaussians. Gaussians that are not drawn become inactive.
    WARPAGG_HD void draw(const W& w, gaussian_row<W>& row, const vec3<real>& mean, const vec3<real>& at,
                         drawing& d) const {
        const auto log_scale = row.template load<3>(w, gaussians.log_scale, 0, 3);
        const auto quaternion = row.template load<4>(w, gaussians.quaternion, 0, 4);
        const real logit = row.template load<1>(w, gaussians.opacity, 0, 1).x;
        const footprint<real, Effects> f(at, log_scale, quaternion, camera);
        real opacity = sigmoid(logit);
        if constexpr (Effects.antialiasing) opacity *= opacity_left(whitened_axes<real>(f.shape, f.ax, f.ay));
        if constexpr (Effects.motion) opacity *= f.motion.template opacity_left<Effects>(f.shape, f.ax, f.ay);
        opacity *= real(Real(dropout.gain));
        splat<real>& s = d.shape;
        s.log2_opacity = warpagg::math::log2(opacity);
        s.cutoff = warpagg::math::log2(opacity * constant<real>(1 / least_alpha));
        row.active = row.active && f.drawable && is_finite(logit) && s.cutoff > real(0);
        if (!w.any(row.active)) return;
        s.x = f.seen.x;
        s.y = f.seen.y;
        s.p = f.shape.p;
        s.q = f.shape.q;
        s.r = f.shape.r;
        s.dx_per_dy = f.shape.dx_per_dy;
        s.dy_per_dx = f.shape.dy_per_dx;
        const real far = warpagg::math::sqrt(s.cutoff);
        bound(far * f.shape.width, far * f.shape.height, d);
        row.active = reaches_box(w, d, row.active);
        if (!w.any(row.active)) return;

        const vec3<real> rgb = color(w, row, mean);
        row.active = row.active && is_finite(rgb);
        s.red = held(rgb.x);
        s.green = held(rgb.y);
        s.blue = held(rgb.z);
    }

    /// Returns which splats reach a tile of their boxes.
    /// @{
    WARPAGG_HD mask_t<W> reaches_box(const W& w, const drawing& d, const mask_t<W>& asked) const {
        if constexpr (Effects.lens == lens_model::panorama) return reaches_box_around(w, d, asked);
        return reaches_any_tile(w, d.shape, d.x0, d.x1, d.y0, d.y1, asked);
    }
    WARPAGG_HD mask_t<W> reaches_box_around(const W& w, const drawing& d, const mask_t<W>& asked) const {
        const panorama_size size{camera.width, tiles_across};
        return reaches_any_tile(w, d.x0, d.x1, d.y0, d.y1, asked, [&](const auto&... box) {
            return reaches_tiles_around(d.shape, box..., size);
        });
    }
    /// @}

    /// Returns the tile of a pixel along an axis, from 0 to `end`.
    static WARPAGG_HD number tile(const real& pixel, unsigned end) {
        using namespace warpagg::math;
        const real t = pixel * constant<real>(1.0 / tile_size);
        return convert<std::uint32_t>(convert<int>(min(max(real(0), t), real(Real(end)))));
    }
    /// Sets the box to all tiles that may have a pixel center within these distances of the splat's
    /// center.
    WARPAGG_HD void bound(const real& half_x, const real& half_y, drawing& d) const {
        const real half = constant<real>(0.5), side = constant<real>(tile_size);
        const real x = d.shape.x - half, y = d.shape.y - half;
        d.x0 = tile(x - half_x, tiles_across);
        d.y0 = tile(y - half_y, tiles_down);
        d.x1 = tile(x + half_x + side, tiles_across);
        d.y1 = tile(y + half_y + side, tiles_down);
        if constexpr (Effects.lens == lens_model::panorama) bound_around(x - half_x, x + half_x, d);
    }
    /// Sets the columns of the box to those with pixels from `first` to `last` in a panorama, each
    /// at most once.
    WARPAGG_HD void bound_around(const real& first, const real& last, drawing& d) const {
        const real width = real(Real(camera.width)), side = constant<real>(tile_size);
        const number all(tiles_across), none(0u);
        const auto from_left = first < real(0), to_right = last >= width;
        const auto everywhere = last - first > width - side;
        const number end = tile(select(to_right, last - width, last) + side, tiles_across);
        d.x0 = select(everywhere, none, tile(select(from_left, first + width, first), tiles_across));
        d.x1 = select(everywhere, all, end + select(from_left || to_right, all, none));
    }

    static WARPAGG_HD real held(const real& channel) {
        return warpagg::math::min(warpagg::math::max(channel, real(0)), constant<real>(most_color));
    }

    WARPAGG_HD vec3<real> color(const W& w, const gaussian_row<W>& row, const vec3<real>& mean) const {
        const int degree = row.degree_of(gaussians, sh_degree);
        const vec3<real> direction = unit(mean - camera.center).direction;
        real basis[16]{};
        sh_basis(degree, direction, basis);
        const std::uint32_t cache_slot = degree > 0 ? row.cache_slot(gaussians) : 0;
        vec3<real> sum(constant<real>(0.5));
        WARPAGG_UNROLL
        for (unsigned band = 0; band < 4; ++band) {
            if (static_cast<int>(band) > degree) break;
            const unsigned size = 2 * band + 1;
            const row_place<W> at(row, sh_band(static_cast<int>(band)), cache_slot);
            WARPAGG_UNROLL
            for (unsigned m = 0; m < size; ++m)
                sum +=
                    basis[band * band + m] * at.row.template load<3>(w, at.array(gaussians), 3 * m, 3 * size);
        }
        return sum;
    }
};

}  // namespace gs::raster
