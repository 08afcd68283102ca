// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "../core/error.hpp"
#include "../device/device.hpp"
#include "blend/blend_backward.hpp"
#include "blend/blend_forward.hpp"
#include "gradients/gradient_sums.hpp"
#include "project/own_splats.hpp"
#include "project/splat_exchange.hpp"
#include "renderer_bytes.hpp"
#include "tiles/bin.hpp"
#include "tiles/strip_lists.hpp"
#include "tiles/tile_schedule.hpp"
#include "tiles/view_stack.hpp"
#include "tiles/view_strip.hpp"

namespace gs::raster {

// knob: renderer
/// Draws Gaussians, and computes the gradients of their parameters from dL/dimage. Owns the memory
/// for all intermediate results. `Accumulators`: an `accumulator_set`, from which `backward`
/// chooses at run time.
template <device::device Device, class Real, class Cut = cut_for<typename Device::warp>,
          class Accumulators = product_accumulators>
class renderer {
  public:
    using device_type = Device;
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using warp = typename Device::warp;
    using model = parameter_arrays<const Real>;
    using bytes = renderer_bytes<Device, Real, Cut>;

    explicit renderer(Device& device)
        : device_(device),
          own_(device),
          exchange_(device),
          strip_lists_(device),
          sums_(device),
          schedule_(device) {
        device_.zero(reserve(pairs_, 2).data(), 2);
        device_.zero(reserve(required_, 1).data(), 1);
    }

    /// Sets the effects of all later draws; initially none. The lens comes from the view.
    void set_effects(const effect_set& effects) { effects_ = effects; }
    /// Limits all later draws to the strip of this rank, or draws whole views. With a strip, `measure`,
    /// `list`, `blend_depths` and the backward pass are collective functions of all ranks, whose strips must
    /// differ. `measure` uses `view_strip::gaussians` only. A rank projects its own share of the Gaussians,
    /// needs the parameters of these only, and passes only their gradients to the sink.
    void set_strip(const std::optional<view_strip>& strip) {
        if (strip.has_value() != strip_.has_value()) {  // whole views and strips need different memory
            strip ? release_splats() : release_exchange();
            gaussian_of_ = {};
            checkpoints_ = {};
        }
        strip_ = strip;
    }
    /// Frees memory that only strips need, until the next draw of one.
    void release_strips() {
        release_exchange();
        strip_places_ = 0;
    }

    /// Counts the instances (Gaussian, tile) of a whole view: see `instances`.
    void measure(const model& gaussians, std::size_t count, const camera& view, int sh_degree) {
        project_own(gaussians, count, view, sh_degree);
        with_items<Real>(
            views_[0], {own_.order.data(), own_.of(own_.splats), own_.of(own_.boxes), views_.tiles_across()},
            [&](const auto& items) { place_lists(items, own_.count(), 0); });
        if (strip_) device_.sum_over_ranks(required_.data(), 1);
    }
    /// Returns the number of instances of the last view that was drawn or measured. Waits for the
    /// device.
    std::uint64_t instances() {
        std::uint64_t n = 0;
        device_.download(&n, required_.data(), 1);
        return n;
    }

    /// Permits this number of instances per view, and `spare` more within the limit of 31 bits. `forward`
    /// drops instances that do not fit: see `capacity`. One rank reserves memory for all of them. If there
    /// are several, a view or a strip gets memory for those that it lists.
    void reserve_instances(std::uint64_t most, std::uint64_t spare = 0) {
        constexpr std::uint64_t limit = std::uint64_t{1} << 31;
        if (most >= limit)
            throw error("a view has " + std::to_string(most) +
                        " pairs of Gaussian and tile, more than 2^31: lower --max-cap or --resolution");
        capacity_ = std::min(most + spare, limit - 1);
    }
    std::uint64_t reserved_instances() const { return capacity_; }

    /// Draws the view into `render()`, three planes. `background_image`: three planes that replace
    /// the background; they must exist until `backward`.
    void forward(const model& gaussians, std::size_t count, const camera& view, int sh_degree,
                 const std::array<float, 3>& background, const Real* background_image = nullptr) {
        list(gaussians, count, view, sh_degree);
        blend(background, background_image);
    }

    /// The first part of `forward`: projects the Gaussians and makes the tile lists. Several views need a
    /// strip, also with one rank.
    void list(const model& gaussians, std::size_t count, const view_stack& views, int sh_degree,
              const dropout& dropped = {}) {
        using device::stage;
        const auto scope = exchanging(ranks::purpose::splats);
        device_.begin(stage::project);
        project_own(gaussians, count, views, sh_degree, dropped);
        if (strip_) exchange_splats(strip_->windows);
        device_.begin(stage::bin);
        bin();
        if (strip_) complete_lists();
        device_.begin(stage::blend_forward);
        render_.resize(3 * views.pixels());
        transmittance_.resize(views.pixels());
        last_.resize(views.pixels());
        checkpoints_.resize(segments() * checkpoint_values);
        gaussians_ = gaussians;
        sh_degree_ = sh_degree;
        effects_.depth = false;
    }
    /// The second part of `forward`: blends.
    void blend(const std::array<float, 3>& background, const Real* background_image = nullptr) {
        background_ = {color(background)};
        background_image_ = {background_image};
        with_cut([&]<class Shape> {
            background_image == nullptr ? blend_forward_by<Shape>(background_, lists(), pairs_.data())
                                        : blend_forward_by<Shape>(background_image_, lists(), pairs_.data());
        });
        if (!strip_) return;
        device_.zero(reserve(work_, views_.tiles_down()).data(), views_.tiles_down());
        const ranks::share own = tiles_in(strip_->own);
        device_.for_each_index(own.count(),
                               measure_work{last_.data(), static_cast<unsigned>(views_.width()),
                                            static_cast<unsigned>(views_.height()), views_.tiles_across(),
                                            own.first, ranges_.data(), work_.data()});
    }

    /// Called between both parts: draws the inverse depths, the sum of w_i / z_i with the weights
    /// of the colors, on a background of zero. They are the first plane of `render()` until
    /// `blend`. The time of this and the next function counts as forward blending.
    void blend_depths() {
        near_.resize(listed_count());
        own_.show_depths(gaussians_.mean, views_, near_);
        if (strip_) {
            const auto scope = exchanging(ranks::purpose::splats);
            exchange_.send_again(near_.data(), near_.data() + own_.count());
        }
        background_ = {};
        with_cut(
            [&]<class Shape> { blend_forward_by<Shape>(background_, depth_lists(), pairs_.data() + 1); });
    }
    /// Adds the gradient of the inverse depths, three planes of which the last two are zero, to the
    /// sums. `backward` continues with them and needs the same `largest` and `how`.
    void backward_depths(const Real* gradient, float largest, accumulator how) {
        with_cut([&]<class Shape> {
            Accumulators::template with_kernel<Real, Shape>(how, [&](auto kernel) {
                sums_.begin(kernel, listed_count(), largest, kernel.template warps_of_sum<warp>(tiles()));
                launch_backward(kernel, depth_lists(), gradient);
                sums_.set_depths_aside(kernel);
            });
        });
        effects_.depth = true;
    }

    /// Computes the gradients of all parameters from the gradient of the last image, and passes
    /// them to `sink`: see `project_backward`. Colors are included up to an SH degree. `largest` is
    /// the approximate magnitude of a pixel's gradient: see `gradient_sums`. `seen` may be null.
    template <class Sink>
    void backward(const Real* render_gradient, float largest, accumulator how, int learned_sh_degree,
                  const Sink& sink, visibility* seen) {
        const Real* sums = backward_to_splats(render_gradient, largest, how);
        backward_from_splats(sums, learned_sh_degree, sink, seen);
    }
    /// The first part of `backward`. Returns the sums over pixels of each of the `own_gaussians` in each
    /// view.
    const Real* backward_to_splats(const Real* render_gradient, float largest, accumulator how) {
        const Real* sums = pixel_sums(render_gradient, largest, how);
        device_.begin(device::stage::project_backward);
        return sums;
    }
    /// The second part of `backward`, for one of the views. Several sinks can take the gradients of the same
    /// sums.
    template <class Sink>
    void backward_from_splats(const Real* sums, int learned_sh_degree, const Sink& sink, visibility* seen,
                              std::size_t view = 0) {
        own_.project_back(gaussians_, views_[view], view, effects_, sh_degree_, learned_sh_degree, sums, sink,
                          seen, capacity());
    }

    /// Returns the sums over pixels of each of the `own_gaussians` that was drawn, view by view.
    const Real* pixel_sums(const Real* render_gradient, float largest, accumulator how) {
        const Real* sums = nullptr;
        with_cut([&]<class Shape> {
            Accumulators::visit(how, [&]<class Variant>(Variant) {
                using kernel = typename Variant::template kernel<Real, Shape>;
                if (background_image_.planes == nullptr) {
                    sums = sums_by(kernel{}, render_gradient, largest);
                } else if constexpr (Variant::supports_background_image) {
                    using before_colors =
                        typename Variant::template kernel<Real, Shape, image_background<Real>>;
                    sums = sums_by(before_colors{}, render_gradient, largest);
                } else {
                    throw error(
                        "this accumulator has no gradient for an image in front of a learned background");
                }
            });
        });
        return sums;
    }

    /// Runs the blending part of `backward` with this kernel, whose members it sets. Returns the
    /// sums of the `own_gaussians`: see `project_backward`.
    template <class Kernel>
    const buffer<Real>& blend_backward_by(Kernel kernel, const Real* render_gradient, float largest) {
        sums_.begin(kernel, listed_count(), largest, kernel.template warps_of_sum<warp>(tiles()),
                    effects_.depth);
        device_.begin(device::stage::blend_backward);
        launch_backward(kernel, lists(), render_gradient);
        if (!strip_) return sums_.end(kernel);
        const auto scope = exchanging(ranks::purpose::gradients);
        return sums_.end_for_owners(kernel, exchange_, own_.count());
    }
    /// See `gradient_sums`.
    std::uint32_t* fault() const { return sums_.fault(); }

    /// The splats of the last view, by Gaussian, of the `own_gaussians`.
    const splat<Real>* splats() const { return own_.of(own_.splats); }
    /// The number of tiles that each of these may touch; zero if it is not drawn.
    const std::uint32_t* tiles_of() const { return own_.of(own_.tiles); }
    const Real* render() const { return render_.data(); }
    /// The transmittance of each pixel behind all splats, of the last `forward`.
    const Real* transmittance() const { return transmittance_.data(); }
    /// The rows of pixels of one of the last views that are this rank's own.
    row_range own_rows(std::size_t view = 0) const {
        const row_range whole{0, views_.height()};
        return views_.rows_of(view, strip_ ? strip_->own_pixels(views_.height()) : whole);
    }
    /// The views that were drawn or measured last.
    const view_stack& views() const { return views_; }
    /// The number of Gaussians of the last view.
    std::size_t gaussians() const { return count_; }
    /// The Gaussians of the last view that this rank projects and passes to the sink of `backward`.
    ranks::share own_gaussians() const {
        return strip_ ? strip_->gaussians.of(device_.ranks().rank()) : ranks::share{0, count_};
    }
    /// The exchange of splats of the last view with a strip.
    const splat_exchange<Device, Real>& exchange() const { return exchange_; }
    /// The size of the memory that only strips need, if sums are accumulated this way.
    std::size_t strip_bytes(accumulator how) const {
        return exchange_.bytes() + strip_lists_.bytes() + exchange_.received() * bytes::per_received(how);
    }
    /// The number of instances for which strips have memory. Zero if it is not known yet.
    std::uint64_t strip_places() const { return strip_places_; }
    /// The work of the last view's tile rows, on the device: see `measure_work`. Zero for those of others.
    std::span<const unsigned long long> row_work() const { return {work_.data(), views_.tiles_down()}; }
    /// Whether the last view's instances fit.
    list_capacity capacity() const { return {required_.data(), capacity_}; }
    /// A counter on the device: pixel-Gaussian pairs that all calls of `forward` have evaluated.
    const unsigned long long* pairs() const { return pairs_.data(); }

  private:
    template <class Kernel>
    const Real* sums_by(const Kernel& kernel, const Real* render_gradient, float largest) {
        return blend_backward_by(kernel, render_gradient, largest).data() -
               own_gaussians().first * record_stride;
    }

    ranks::traffic_counter::scope exchanging(ranks::purpose of_step) const {
        return {device_.ranks().traffic(), strip_ && !strip_->is_of_step ? ranks::purpose::scores : of_step};
    }
    void release_exchange() {
        exchange_.release();
        strip_lists_.release();
    }
    void release_splats() {
        own_.release();
        near_ = {};
    }
    /// Returns the number of splats that tile lists may refer to.
    std::size_t listed_count() const { return own_.count() + (strip_ ? exchange_.received() : 0); }

    template <class T>
    static buffer<T>& reserve(buffer<T>& b, std::size_t n) {
        b.resize(n);
        return b;
    }

    /// Calls `f.template operator()<Shape>()` with the division of the current view.
    template <class F>
    void with_cut(const F& f) const {
        with_flag(views_.is_panorama(), [&]<bool Panorama> {
            f.template operator()<std::conditional_t<Panorama, panorama_cut<Cut>, Cut>>();
        });
    }
    std::size_t tiles() const { return std::size_t{views_.tiles_across()} * views_.tiles_down(); }
    row_range all_rows() const { return {0, static_cast<int>(views_.tiles_down())}; }
    /// Returns the tile rows with tile lists.
    row_range listed_rows() const { return strip_ ? strip_->listed(all_rows().last) : all_rows(); }
    /// Returns the tiles of some tile rows.
    ranks::share tiles_in(const row_range& rows) const {
        return {static_cast<std::size_t>(rows.first) * views_.tiles_across(),
                static_cast<std::size_t>(rows.last) * views_.tiles_across()};
    }
    template <class Kernel>
    void launch_backward(Kernel& kernel, const tile_lists<Real>& lists, const Real* render_gradient) {
        kernel.lists = lists;
        const auto view = [&](const auto& background) {
            return blended{background,   render_.data(),      transmittance_.data(),
                           last_.data(), checkpoints_.data(), render_gradient};
        };
        if constexpr (std::is_same_v<decltype(kernel.view.background), image_background<Real>>)
            kernel.view = view(background_image_);
        else
            kernel.view = view(background_);
        kernel.tile_of_segment = schedule_.tile_of_segment();
        // knob: backward_warps
        device_.for_each_warp(kernel.template warps<warp>(tiles(), segments()), kernel);
    }
    /// Lower patches are smaller pieces of work. They are used if higher ones would leave the
    /// device idle.
    template <class Shape, class Backdrop>
    void blend_forward_by(const Backdrop& background, const tile_lists<Real>& lists,
                          unsigned long long* pairs) {
        using shorter = lower<Shape>;
        const blend_forward<Real, Shape, Backdrop> blend{
            lists,        schedule_.order(),   background, render_.data(), transmittance_.data(),
            last_.data(), checkpoints_.data(), pairs};
        const std::size_t n = blend.template warps<warp>(tiles_in(listed_rows()).count());
        if constexpr (!std::is_same_v<Shape, shorter>) {
            if (n < 2 * device_.resident_warps()) return blend_forward_by<shorter>(background, lists, pairs);
        }
        device_.for_each_warp(n, blend);
    }

    std::size_t segments() const {
        return most_segments<Cut>(tiles(), strip_ ? strip_places_ + Cut::segment : whole_places_);
    }
    tile_lists<Real> lists() const {
        return {own_.splats.data(),    gaussian_of_.data(), ranges_.data(),
                views_.tiles_across(), views_.width(),      views_.height()};
    }
    tile_lists<Real> depth_lists() const {
        tile_lists<Real> all = lists();
        all.splats = near_.data();
        return all;
    }

    void project_own(const model& gaussians, std::size_t count, const view_stack& views, int sh_degree,
                     const dropout& dropped = {}) {
        for (std::size_t v = 0; v < views.count(); ++v) require_drawable(views[v]);
        views_ = views;
        count_ = count;
        own_.project(gaussians, count, own_gaussians(), views, effects_, sh_degree, dropped,
                     expected_splats());
    }
    /// Returns the number of splats that others probably send.
    std::size_t expected_splats() const {
        if (!strip_) return 0;
        return strip_->windows ? strip_->windows->received_by(device_.ranks().rank()).items()
                               : exchange_.received();
    }
    /// Gives each rank the splats of its strip.
    void exchange_splats(const std::optional<ranks::windows>& expected) {
        exchange_.begin(own_.count(), strip_->listed_by_all(all_rows().last), own_.boxes.data(),
                        own_.tiles.data(), expected);
        if (listed_count() > own_.splats.size()) {
            buffer<splat<Real>> more;
            more.resize(listed_count());
            device_.copy(more.data(), own_.splats.data(), own_.count());
            own_.splats = std::move(more);
        }
        exchange_.send(own_.splats.data(), own_.boxes.data(), own_.depths.data(),
                       own_.splats.data() + own_.count());
    }
    /// Makes the lists of a strip again if a rank has sent more splats than expected, or if the lists have
    /// too little memory.
    void complete_lists() {
        if (strip_->windows && !exchange_.fits()) {
            exchange_splats({});
            bin();
        }
        if (const std::uint64_t needed = strip_lists_.needed_places(capacity_); needed > strip_places_) {
            strip_places_ = std::min(needed + needed / 4, capacity_);  // later lists are often longer
            bin(true);
        }
        if (strip_->is_of_step) device_.ranks().traffic().count_step(exchange_.drawn(), exchange_.moved());
    }

    /// Makes the list of Gaussians of each tile, front to back. Equal depths keep the order of the
    /// Gaussians. `again`: this rank alone makes the lists of its strip again.
    void bin(bool again = false) {
        if (strip_) {
            gaussian_of_.resize(strip_places_ + Cut::segment);
            list_strip(again);
        } else {
            device_.sort_pairs(own_.depths, own_.order, count_);
            with_items<Real>(
                views_[0], {own_.order.data(), own_.splats.data(), own_.boxes.data(), views_.tiles_across()},
                [&](const auto& items) {
                    place_lists(items, count_, capacity_);
                    whole_places_ =
                        device_.ranks().count() == 1 ? capacity_ : std::min(instances(), capacity_);
                    gaussian_of_.resize(whole_places_ + Cut::segment);
                    device_.write_lists(count_, items, tiles(), whole_places_, gaussian_of_.data(),
                                        ranges_.data());
                });
        }
        const bool has_own_rows = strip_ && strip_->own.count() > 0;
        schedule_.template make<Cut>(ranges_.data(), tiles(), tiles_in(listed_rows()),
                                     tiles_in(has_own_rows ? strip_->own : all_rows()), segments());
    }
    template <class Items>
    void place_lists(const Items& items, std::size_t count, std::uint64_t capacity) {
        device_.place_lists(count, items, tiles(), capacity, reserve(ranges_, tiles()).data(),
                            required_.data());
    }
    void list_strip(bool again) {
        if (!again)
            strip_lists_.sort({own_.count(), exchange_.received(), exchange_.received_before(),
                               own_.boxes.data(), own_.depths.data(), exchange_.received_reach()},
                              listed_rows());
        device_.zero(reserve(ranges_, tiles()).data(), tiles());  // of tiles without a list
        with_items<Real>(
            views_[0],
            {strip_lists_.order(), own_.splats.data(), strip_lists_.boxes(), views_.tiles_across(),
             static_cast<std::uint32_t>(tiles_in(listed_rows()).first)},
            [&](const auto& items) {
                const auto scope = exchanging(ranks::purpose::lists);
                const strip_place_in_view at{
                    strip_->own,         listed_rows(),   views_.tiles_across(),
                    views_.tiles_down(), capacity_,       {gaussian_of_.data(), gaussian_of_.size()},
                    ranges_.data(),      required_.data()};
                again ? strip_lists_.make_again(items, listed_count(), at)
                      : strip_lists_.make(items, listed_count(), at);
            });
    }

    static vec3<Real> color(const std::array<float, 3>& c) { return {Real(c[0]), Real(c[1]), Real(c[2])}; }

    Device& device_;
    own_splats<Device, Real> own_;
    buffer<splat<Real>> near_;  ///< see `depth_splats`
    buffer<std::uint32_t> gaussian_of_;
    buffer<std::uint64_t> required_;
    buffer<tile_range> ranges_;
    buffer<Real> render_, transmittance_, checkpoints_;
    splat_exchange<Device, Real> exchange_;  ///< with a strip, like the next
    strip_lists<Device, Cut::segment> strip_lists_;
    gradient_sums<Device, Real> sums_;  // knob: renderer_members
    buffer<std::uint32_t> last_;
    tile_schedule<Device> schedule_;
    buffer<unsigned long long> work_;
    buffer<unsigned long long> pairs_;  ///< one counter for colors, and an unused one for depths
    std::uint64_t capacity_ = 0, whole_places_ = 0, strip_places_ = 0;

    std::optional<view_strip> strip_;  ///< if unset, views are drawn whole

    effect_set effects_;

    view_stack views_;  ///< those that were drawn or measured last

    // The other arguments of the last `forward`, which `backward` uses.
    model gaussians_;
    std::size_t count_ = 0;
    int sh_degree_ = 0;
    constant_background<Real> background_{};
    image_background<Real> background_image_{};
};

}  // namespace gs::raster
