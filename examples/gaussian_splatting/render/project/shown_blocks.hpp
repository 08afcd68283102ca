// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../geometry/effect_set.hpp"
#include "../geometry/splat.hpp"
#include "gaussian_row.hpp"
#include "geometry.hpp"

namespace gs::raster {

/// See the function `find_shown_blocks`. One block per warp.
template <class W, class Real, lens_model Lens>
struct shown_blocks {
    static constexpr effect_set effects{.lens = Lens};
    using real = value_t<W, Real>;
    using number = value_t<W, std::uint32_t>;

    const Real* mean;   ///< means of all Gaussians, see `parameter_arrays`
    std::size_t count;  ///< number of Gaussians
    camera_type<real, effects> camera;
    std::uint32_t* shown;
    bool adds;  ///< whether blocks that another view shows stay 1

    WARPAGG_HD void operator()(const W& w, unsigned block) const {
        mask_t<W> any = adds && shown[block] != 0;
        for (unsigned part = 0; part < block_length; part += W::size) {
            const number i = w.lane() + (block * static_cast<unsigned>(block_length) + part);
            const mask_t<W> inside = i < number(static_cast<std::uint32_t>(count));
            const gaussian_row<W> row{block * block_length + part, inside, inside};
            any = any || (inside && is_shown(row.template load<3>(w, mean, 0, 3)));
        }
        const number is_any(w.any(any) ? 1u : 0u);
        w.store(shown, number(block), is_any, w.lane() == number(0u));
    }

  private:
    static constexpr int beside = static_cast<int>(tile_size);

    WARPAGG_HD mask_t<W> is_shown(const vec3<real>& center) const {
        using projection = projection_of<real, effects>;
        const vec3<real> at = in_camera(center, camera);
        const projection seen(at, camera);
        return projection::is_drawn(at, camera) && is_near(seen.x, camera.width) &&
               is_near(seen.y, camera.height);
    }
    static WARPAGG_HD mask_t<W> is_near(const real& pixel, int pixels) {
        return pixel > -constant<real>(beside) && pixel < real(Real(pixels + beside));
    }
};

/// Sets `shown` to 1 for each AoSoA block of `count` Gaussians that a view shows, and to 0 for the others,
/// unless it `adds` to those of another view.
/// The view shows a block if the center of a Gaussian is in the picture, or beside it by less than a tile.
/// Large Gaussians farther away may be drawn, too.
template <class Device, class Real>
void find_shown_blocks(Device& device, const Real* mean, std::size_t count, const camera& view,
                       std::uint32_t* shown, bool adds = false) {
    using narrow = typename Device::narrow_warp;
    with_lens(view.lens(), [&]<lens_model Lens> {
        using kernel = shown_blocks<narrow, Real, Lens>;
        device.template for_each_warp<narrow>(
            in_whole_blocks(count) / block_length,
            kernel{mean, count, camera_for<value_t<narrow, Real>, kernel::effects>(view), shown, adds});
    });
}

}  // namespace gs::raster
