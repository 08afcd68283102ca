// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../model/spherical_harmonics.hpp"
#include "bits.hpp"
#include "geometry.hpp"
#include "splat.hpp"

namespace gs::raster {

/// The tiles that a splat's bounding box meets: [x0, x1) × [y0, y1).
struct tile_box {
    std::uint16_t x0, y0, x1, y1;

    WARPAGG_HD std::uint32_t size() const { return std::uint32_t(x1 - x0) * std::uint32_t(y1 - y0); }
};

/// Whether the splat's ellipse reaches pixels of the tile in this column and row.
template <class Real>
WARPAGG_HD bool reaches_tile(const splat<Real>& s, unsigned column, unsigned row) {
    const Real x0 = Real(column * tile_size) + Real(0.5) - s.x, y0 = Real(row * tile_size) + Real(0.5) - s.y;
    const Real side = tile_size - 1;
    return least_exponent<Real>(s.p, s.q, s.r, s.slope_x, s.slope_y, x0, x0 + side, y0, y0 + side) <= s.reach;
}

/// Whether it reaches any tile of the box.
template <class Real>
WARPAGG_HD bool reaches_any(const splat<Real>& s, const tile_box& box) {
    for (unsigned row = box.y0; row < box.y1; ++row)
        for (unsigned column = box.x0; column < box.x1; ++column)
            if (reaches_tile(s, column, row)) return true;
    return false;
}

/// Gaussians to splats: one index a Gaussian.
template <class Real>
struct project {
    parameter_arrays<const Real> gaussians;
    device_camera<Real> camera;
    int sh_degree;
    unsigned tiles_across, tiles_down;

    splat<Real>* splats;
    tile_box* boxes;
    std::uint32_t* depths;      ///< the depth as a sort key: a positive float's bits are in its order
    std::uint32_t* identities;  ///< i: the value that is sorted along
    std::uint32_t* tiles;       ///< how many tiles the splat's box has; zero if it is not drawn

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        identities[i] = i;
        depths[i] = 0xffffffffu;
        tiles[i] = 0;
        boxes[i] = {0, 0, 0, 0};
        splats[i] = {};

        const vec3<Real> at = in_camera(load3(gaussians.mean, i), camera);
        if (!(at.z > Real(near_plane))) return;
        const footprint<Real> f =
            see(at, load3(gaussians.log_scale, i), load4(gaussians.quaternion, i), camera);
        if (!f.drawable || !is_finite(gaussians.opacity[i])) return;
        splat<Real> s{};
        const Real opacity = sigmoid(gaussians.opacity[i]);
        s.strength = glm::log2(opacity);
        s.reach = glm::log2(opacity * Real(1 / least_alpha));
        if (!(s.reach > 0)) return;
        s.x = f.x;
        s.y = f.y;
        s.p = f.shape.p;
        s.q = f.shape.q;
        s.r = f.shape.r;
        s.slope_x = f.shape.slope_x;
        s.slope_y = f.shape.slope_y;
        const Real far = warpagg::math::sqrt(s.reach);
        const tile_box box = bounds(s, far * f.shape.width, far * f.shape.height);
        if (!reaches_any(s, box)) return;

        const vec3<Real> rgb = colour(i);
        if (!is_finite(rgb)) return;
        s.red = held(rgb.x);
        s.green = held(rgb.y);
        s.blue = held(rgb.z);
        splats[i] = s;
        boxes[i] = box;
        tiles[i] = box.size();
        depths[i] = bits_of(static_cast<float>(f.at.z));
    }

  private:
    /// The tiles that hold a pixel centre within these half extents.
    WARPAGG_HD tile_box bounds(const splat<Real>& s, Real half_x, Real half_y) const {
        const auto tile = [](Real pixel, unsigned end) {
            const Real t = glm::floor(pixel / tile_size);
            return static_cast<std::uint16_t>(warpagg::math::min(warpagg::math::max(Real(0), t), Real(end)));
        };
        const Real half(0.5);
        return {tile(s.x - half_x - half, tiles_across), tile(s.y - half_y - half, tiles_down),
                tile(s.x + half_x - half + tile_size, tiles_across),
                tile(s.y + half_y - half + tile_size, tiles_down)};
    }

    static WARPAGG_HD Real held(Real channel) {
        return warpagg::math::min(warpagg::math::max(channel, Real(0)), Real(most_colour));
    }

    WARPAGG_HD vec3<Real> colour(unsigned i) const {
        const vec3<Real> direction = unit(load3(gaussians.mean, i) - camera.centre).direction;
        Real basis[16]{};
        sh_basis(sh_degree, direction, basis);
        vec3<Real> sum(0.5);
        WARPAGG_UNROLL
        for (unsigned band = 0; band < 4; ++band) {
            if (static_cast<int>(band) > sh_degree) break;
            const unsigned size = 2 * band + 1;
            WARPAGG_UNROLL
            for (unsigned m = 0; m < size; ++m)
                sum += basis[band * band + m] * load3(gaussians.sh[band], i, 3 * m, 3 * size);
        }
        return sum;
    }
};

}  // namespace gs::raster
