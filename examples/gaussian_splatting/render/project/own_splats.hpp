// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../device/device.hpp"
#include "../../ranks/shares.hpp"
#include "../tiles/tile_reach.hpp"
#include "../tiles/view_stack.hpp"
#include "depth_splats.hpp"
#include "project.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// Moves splats to a view that begins at this tile row of a picture. One index per splat.
template <class Real>
struct move_to_view {
    unsigned tile_row;
    splat<Real>* splats;
    tile_box* boxes;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (boxes[i].size() == 0) return;
        splats[i].y += static_cast<Real>(tile_row * tile_size);
        boxes[i].y0 = static_cast<std::uint16_t>(boxes[i].y0 + tile_row);
        boxes[i].y1 = static_cast<std::uint16_t>(boxes[i].y1 + tile_row);
    }
};

/// The splats of this rank's Gaussians in a picture: those of the first view, then those of the next one, and
/// so on.
template <device::device Device, class Real>
class own_splats {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using narrow = typename Device::narrow_warp;
    using model = parameter_arrays<const Real>;

  public:
    explicit own_splats(Device& device) : device_(device) {}

    void release() {
        splats = {};
        boxes = {};
        for (auto* values : {&depths, &order, &tiles}) *values = {};
    }

    /// Projects these Gaussians of `count`. Reserves memory for `more` splats behind the own ones.
    void project(const model& gaussians, std::size_t count, const ranks::share& own, const view_stack& views,
                 const effect_set& effects, int sh_degree, const dropout& dropped, std::size_t more) {
        count_ = count;
        own_ = own;
        views_ = views.count();
        splats.resize(this->count() + more);
        boxes.resize(this->count());
        for (auto* values : {&depths, &order, &tiles}) values->resize(this->count());
        for (std::size_t v = 0; v < views_; ++v) {
            const camera& view = views[v];
            const auto across = static_cast<unsigned>((view.width + tile_size - 1) / tile_size),
                       down = static_cast<unsigned>((view.height + tile_size - 1) / tile_size);
            with_effects(in_view(effects, view), [&]<effect_set Effects> {
                constexpr effect_set seen{Effects.antialiasing, Effects.lens, false, Effects.motion};
                device_.template for_each_warp<narrow>(
                    warps(), raster::project<narrow, Real, seen>{
                                 gaussians, count, camera_for<value_t<narrow, Real>, seen>(view), sh_degree,
                                 across, down, of(splats, v), of(boxes, v), of(depths, v), of(order, v),
                                 of(tiles, v), dropped});
            });
            if (v > 0)
                device_.for_each_index(
                    own.count(),
                    move_to_view<Real>{static_cast<unsigned>(v) * views.tiles_of_view(),
                                       splats.data() + v * own.count(), boxes.data() + v * own.count()});
        }
    }
    /// Makes splats that show inverse depths instead of colors: see `depth_splats`.
    void show_depths(const Real* mean, const view_stack& views, buffer<splat<Real>>& shown) const {
        for (std::size_t v = 0; v < views_; ++v)
            with_lens(views[v].lens(), [&]<lens_model Lens> {
                device_.for_each_index(
                    own_, depth_splats<Real, effect_set{.lens = Lens}>{mean, for_device<Real>(views[v]),
                                                                       of(splats, v), of(shown, v)});
            });
    }
    /// Runs `project_backward` for the view `v`. `sums`: those of `count()` splats.
    template <class Sink>
    void project_back(const model& gaussians, const camera& view, std::size_t v, const effect_set& effects,
                      int sh_degree, int learned_sh_degree, const Real* sums, const Sink& sink,
                      visibility* seen, const list_capacity& capacity) const {
        const Real* const of_view = sums + v * own_.count() * record_stride;
        with_effects(in_view(effects, view), [&]<effect_set Effects> {
            device_.template for_each_warp<narrow>(
                warps(), project_backward<narrow, Real, Sink, Effects>{
                             gaussians, count_, camera_for<value_t<narrow, Real>, Effects>(view), sh_degree,
                             learned_sh_degree, of(splats, v), of(tiles, v), of_view, sink, seen, capacity});
        });
    }

    /// The number of splats, with those that are not drawn.
    std::size_t count() const { return views_ * own_.count(); }
    /// Returns a pointer to the values of a view that the indices of Gaussians refer to.
    template <class T>
    T* of(const buffer<T>& values, std::size_t view = 0) const {
        return values.size() > 0 ? values.data() + view * own_.count() - own_.first : nullptr;
    }

    buffer<splat<Real>> splats;  ///< with others behind them: see `project`
    buffer<tile_box> boxes;
    buffer<std::uint32_t> depths, order, tiles;

  private:
    /// Returns the warps that project the Gaussians of this rank.
    ranks::share warps() const {
        if (own_.count() == 0) return {};  // a share may begin at the end
        return {own_.first / narrow::size, (own_.last + narrow::size - 1) / narrow::size};
    }
    static effect_set in_view(effect_set effects, const camera& view) {
        effects.lens = view.lens();
        effects.motion = view.motion.has_value();
        return effects;
    }

    Device& device_;
    std::size_t count_ = 0, views_ = 1;
    ranks::share own_;
};

}  // namespace gs::raster
