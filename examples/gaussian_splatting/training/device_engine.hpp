// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../core/error.hpp"
#include "../core/parallel.hpp"
#include "../render/renderer.hpp"
#include "../readers/load_views.hpp"
#include "../optimize/adam.hpp"
#include "../features/sh_degree/sh_error.hpp"
#include "../densify/adaptive/densifier.hpp"
#include "../losses/inverse_depth/depth_gradient.hpp"
#include "engine.hpp"
#include "../features/exposure/exposures.hpp"
#include "../losses/losses.hpp"
#include "../metrics/image_comparison.hpp"
#include "../features/sky/sky.hpp"
#include "../optimize/finite_check.hpp"

namespace gs::train {

/// Clamps to [0, 1], as a picture is shown: one index a value.
struct clamp_picture {
    const float* from;
    float* to;
    WARPAGG_HD void operator()(std::size_t i) const {
        to[i] = warpagg::math::min(warpagg::math::max(from[i], 0.0f), 1.0f);
    }
};

/// Notes how long the lists of a view are: one index.
struct note_length {
    raster::list_room room;
    std::uint64_t* length;

    WARPAGG_HD void operator()(std::size_t) const { *length = *room.needed; }
};

/// Counts the steps that were left out, notes how long the lists were, and looks at the loss and at whether
/// all sums fitted: one index.
struct close_step {
    raster::list_room room;
    std::uint64_t* skipped;
    std::uint64_t* length;  ///< of the view's lists
    const double* sums;     ///< see `loss::sums`
    std::size_t sum_count;
    std::uint32_t* unfit;  ///< see `gradient_sums::fault`
    train::watch watch;

    WARPAGG_HD void operator()(std::size_t) const {
        if (room.exceeded()) ++*skipped;
        *length = *room.needed;
        double sum = 0;
        for (std::size_t k = 0; k < sum_count; ++k) sum += sums[k];
        if (!raster::is_finite(sum)) watch.note(fault::loss, 0, 0);
        if (*unfit != 0) watch.note(fault::sum, 0, 0);
        *unfit = 0;
    }
};

/// An `engine` on a device: the order of the kernels, and the memory they share.
template <device::device Device, class Accumulators = raster::product_accumulators>
class device_engine final : public engine {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    device_engine()
        : renderer_(device_),
          comparison_(device_),
          exposures_(device_),
          test_exposures_(device_),
          sky_(device_),
          densification_(device_) {
        skipped_.resize(1);
        device_.zero(skipped_.data(), 1);
        found_.resize(1);
        device_.zero(found_.data(), 1);
        take_findings();
        set_loss(find_loss<Device>(default_loss));
    }

    std::string device_name() const override { return device_.name(); }

    void set_views(const std::vector<view>& train, const std::vector<view>& test, int downscales) override {
        const auto levels = static_cast<std::size_t>(downscales);
        std::vector<std::vector<view>> shrunk(levels, std::vector<view>(train.size()));
        for_each_in_parallel(levels * train.size(), [&](std::size_t i) {
            const std::size_t level = i / train.size(), which = i % train.size();
            shrunk[level][which] = gs::shrunk(train[which], 2 << level);
        });
        std::size_t bytes = 0, depths = 0;
        const auto count = [&](const std::vector<view>& views) {
            for (const view& v : views) {
                bytes += v.pixels.rgba.size();
                depths += v.depths.values.size();
            }
        };
        count(train);
        count(test);
        for (const auto& views : shrunk) count(views);
        photos_.resize(bytes);
        depths_.resize(depths);
        bytes = depths = 0;
        const auto put = [&](const std::vector<view>& views, std::vector<photo>& to) {
            to.clear();
            for (const view& v : views) {
                device_.upload(photos_.data() + bytes, v.pixels.rgba.data(), v.pixels.rgba.size());
                device_.upload(depths_.data() + depths, v.depths.values.data(), v.depths.values.size());
                to.push_back({v.camera, bytes, v.pixels.has_mask, depths, v.depths.is_there()});
                bytes += v.pixels.rgba.size();
                depths += v.depths.values.size();
            }
        };
        train_.resize(1 + levels);
        put(train, train_[0]);
        for (std::size_t level = 0; level < levels; ++level) put(shrunk[level], train_[1 + level]);
        put(test, test_);
        std::vector<glm::vec3> centres;
        for (const view& v : train) centres.emplace_back(v.camera.centre());
        cameras_.resize(centres.size());
        device_.upload(cameras_.data(), centres.data(), centres.size());
        lengths_.resize(train.size());
        set_downscales(0);
        exposures_.set(std::vector<exposure>(train.size(), unexposed));
        test_exposures_.set({});
        depth_fits_.assign(train.size(), {});
        device_.wait();
    }

    void set_model(const gaussians& model) override {
        sh_degree_ = model.sh_degree;
        effects_.antialiasing = model.antialiased;
        renderer_.set_effects(effects_);
        sky_.set(model.sky);
        trained_.values.upload(device_, model);
        for (auto* moments : {&trained_.first, &trained_.second}) {
            moments->resize(model.count(), sh_degree_);
            moments->zero(device_);
        }
        trained_.last_step.resize(model.count());
        device_.zero(trained_.last_step.data(), model.count());
        begin_generation(model.count());
        std::ranges::fill(lengths_of_, 0);
        exposures_.set(std::vector<exposure>(lengths_of_.size(), unexposed));
        device_.wait();
        steps_ = 0;
    }

    gaussians get_model() override {
        gaussians model = trained_.values.download(device_, count_, sh_degree_);
        model.antialiased = effects_.antialiasing;
        model.sky = sky_.get();
        return model;
    }

    std::size_t count() const override { return count_; }

    void set_loss(const std::string& name) override { set_loss(find_loss<Device>(name)); }
    void set_loss(loss_factory<Device> make) {
        loss_ = make(device_);
        ++losses_so_far_;
    }

    void set_downscales(int times) override {
        downscales_ = static_cast<std::size_t>(times);
        if (downscales_ >= train_.size())
            throw error("views were set for " + std::to_string(train_.size() - 1) + " shrinkings, not " +
                        std::to_string(times));
        lengths_of_.assign(train_[downscales_].size(), 0);
    }

    void step(const step_plan& plan) override {
        const gs::camera& camera = train_[downscales_][plan.view].camera;
        const device::iteration_shape shape{
            count_,
            renderer_.reserved_instances(),
            static_cast<std::size_t>(camera.width),
            static_cast<std::size_t>(camera.height),
            static_cast<std::size_t>(plan.gradient),
            (plan.exposure_rate > 0 ? std::size_t{1} : 0) + (sky_.is_there() ? std::size_t{2} : 0) +
                (learns_depth(plan) ? std::size_t{4} : 0) + (camera.fisheye ? std::size_t{8} : 0) +
                16 * losses_so_far_};  // a new loss allocates
        device_.iteration(shape, [&] { iterate(plan); });
        lengths_of_[plan.view] = count_;
    }

    std::uint64_t densify(const densify_rule& rule) override {
        if (count_ == 0) return 0;
        const densify_tally tally = densification_.run(trained_, count_, sh_degree_, seen_.data(), rule);
        begin_generation(tally.count);
        return tally.silent;
    }

    void prune(double share) override {
        const auto dropped = static_cast<std::size_t>(share * static_cast<double>(count_));
        if (dropped == 0) return;
        densification_.drop_least(trained_, count_, sh_degree_, seen_.data(), dropped);
        begin_generation(count_ - dropped);
    }

    void reset_opacity(float most) override {
        device_.for_each_index(count_,
                               lower_opacity{trained_.values.write().opacity, trained_.first.write().opacity,
                                             trained_.second.write().opacity, logit(most)});
    }

    std::vector<exposure> exposures() override { return exposures_.get(); }
    void set_exposures(const std::vector<exposure>& all) override { exposures_.set(all); }
    void set_test_exposures(const std::vector<exposure>& all) override { test_exposures_.set(all); }
    void centre_exposures() override { exposures_.centre(); }

    void set_depth_fits(const std::vector<depth_fit>& all) override { depth_fits_ = all; }

    void clear_cameras() override {
        device_.for_each_index(
            count_, hide_near_cameras{cameras_.data(), cameras_.size(), trained_.values.read().mean,
                                      trained_.values.write().opacity, logit(0)});
    }

    void reserve() override {
        const std::vector<photo>& shots = train_[downscales_];
        for (std::size_t v = 0; v < shots.size(); ++v) {
            if (lengths_of_[v] > 0) continue;  // a step has seen it
            // It does not depend on colours: the least degree will do.
            renderer_.measure(trained_.values.read(), count_, shots[v].camera, 0);
            device_.for_each_index(1, note_length{renderer_.room(), lengths_.data() + v});
            lengths_of_[v] = count_;
        }
        std::vector<std::uint64_t> lengths(shots.size());
        if (!lengths.empty()) device_.download(lengths.data(), lengths_.data(), lengths.size());
        std::uint64_t most = 0;
        double expected = 0;
        for (std::size_t v = 0; v < lengths.size(); ++v) {
            most = std::max(most, lengths[v]);
            if (lengths[v] > 0)
                expected = std::max(expected, static_cast<double>(lengths[v]) * static_cast<double>(count_) /
                                                  static_cast<double>(lengths_of_[v]));
        }
        // With a margin to both sides, so that room seldom changes.
        if (static_cast<double>(renderer_.reserved_instances()) < 1.5 * expected + 1024)
            renderer_.reserve_instances(most, static_cast<std::uint64_t>(2 * expected) + 4096);
    }

    loss_report take_training_loss() override { return loss_->take(); }

    std::uint64_t skipped_steps() override {
        std::uint64_t n = 0;
        device_.download(&n, skipped_.data(), 1);
        return n;
    }

    findings take_findings() override {
        watch::memory found;
        device_.download(&found, found_.data(), 1);
        const watch::memory clean = watch::clean();
        device_.upload(found_.data(), &clean, 1);
        device_.wait();
        return watch::decode(found);
    }

    std::vector<float> render(const camera& camera, const std::array<float, 3>& background,
                              int sh_degree) override {
        draw(camera, background, std::min(sh_degree, sh_degree_));
        return downloaded(renderer_.picture(), camera);
    }

    void set_sh_degree(int degree) override {
        for (auto* all : {&trained_.values, &trained_.first, &trained_.second})
            all->change_sh_degree(device_, sh_degree_, degree);
        sh_degree_ = degree;
    }

    std::size_t drop_bands(double change, accumulator how) override {
        if (count_ == 0 || sh_degree_ == 0) return trained_.values.banded();
        buffer<colour_spread> spreads;
        buffer<float> ones;
        spreads.resize(count_);
        device_.zero(spreads.data(), count_);
        std::size_t values = 0;
        for (const photo& shot : train_.back()) {
            draw(shot.camera, {}, sh_degree_);
            device_.pause_times(true);
            const std::size_t n = values_of(shot.camera);
            ones.resize(n);
            device_.for_each_index(n, make_one{ones.data()});
            const float* sums = renderer_.pixel_sums(ones.data(), 1, how);
            device_.for_each_index(
                count_, note_colours{renderer_.splats(), renderer_.tiles_of(), sums, spreads.data()});
            device_.pause_times(false);
            values += n;
        }
        densification_.drop_bands(trained_, count_, sh_degree_, spreads.data(),
                                  change * change * static_cast<double>(values));
        begin_generation(count_);
        return trained_.values.banded();
    }

    image_quality measure(std::size_t test_view, const std::array<float, 3>& background,
                          std::vector<float>* picture) override {
        const photo& shot = test_[test_view];
        draw(shot.camera, background, sh_degree_);
        const std::size_t n = values_of(shot.camera);
        const float* exposed = test_exposures_.count() > 0
                                   ? test_exposures_.show(test_view, renderer_.picture(), n / 3)
                                   : renderer_.picture();
        shown_.resize(n);
        device_.for_each_index(n, clamp_picture{exposed, shown_.data()});
        comparison_.set_target(target_of(shot, background));
        comparison_.compare(shown_.data());
        if (picture != nullptr) *picture = downloaded(exposed, shot.camera);
        return comparison_.take();
    }

    void sample_times(int every) override { device_.sample_times(every); }
    device::stage_times times() override { return device_.times(); }
    std::uint64_t pairs() override { return all_pairs() - drawn_pairs_; }
    std::size_t peak_device_bytes() const override { return device_.peak_bytes(); }
    void wait() override { device_.wait(); }

  private:
    struct photo {
        gs::camera camera;
        std::size_t first;  ///< byte in `photos_`
        bool masked;
        std::size_t first_depth;  ///< in `depths_`
        bool has_depths;
    };

    static std::size_t values_of(const camera& c) {
        return 3 * static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    }

    target_image target_of(const photo& shot, const std::array<float, 3>& background) const {
        return {photos_.data() + shot.first, shot.camera.width, shot.camera.height, background, shot.masked};
    }

    /// `trained_` holds `count` Gaussians that nobody has seen.
    void begin_generation(std::size_t count) {
        count_ = count;
        seen_.resize(count);
        device_.zero(seen_.data(), count);
    }

    void iterate(const step_plan& plan) {
        using device::stage;
        const photo& shot = train_[downscales_][plan.view];
        loss_->set_target(target_of(shot, plan.background));
        renderer_.list(trained_.values.read(), count_, shot.camera, plan.sh_degree);
        if (learns_depth(plan)) learn_depth(plan);
        renderer_.blend(plan.background, sky_.draw(shot.camera));
        device_.begin(stage::loss);
        const bool exposes = plan.exposure_rate > 0;
        const std::size_t pixels = values_of(shot.camera) / 3;
        const float* shown =
            exposes ? exposures_.show(plan.view, renderer_.picture(), pixels) : renderer_.picture();
        const float* by_picture = loss_->gradient(shown, renderer_.room());
        if (exposes)
            by_picture = exposures_.learn(plan.view, renderer_.picture(), by_picture, pixels,
                                          plan.exposure_rate, renderer_.room());
        if (sky_.is_there())
            sky_.learn(shot.camera, renderer_.transmittance(), by_picture, plan.sky_rate, renderer_.room());
        const train::watch watch{found_.data(), static_cast<std::uint32_t>(plan.iteration)};
        renderer_.backward(by_picture, gradient_scale(plan), plan.gradient,
                           plan.updates_sh ? plan.sh_degree : 0, descent(plan, watch),
                           plan.watch ? seen_.data() : nullptr);
        const std::span<const double> sums = loss_->sums();
        device_.for_each_index(1, close_step{renderer_.room(), skipped_.data(), lengths_.data() + plan.view,
                                             sums.data(), sums.size(), renderer_.fault(), watch});
    }

    bool learns_depth(const step_plan& plan) const {
        return plan.depth_weight > 0 && train_[downscales_][plan.view].has_depths &&
               depth_fits_[plan.view].scale > 0;
    }

    /// Of a pixel of a training photo's depth map.
    float depth_weight(const step_plan& plan) const {
        return 3 * plan.depth_weight / static_cast<float>(values_of(train_[downscales_][plan.view].camera));
    }

    /// The gradients by colors and by inverse depths share their sums.
    float gradient_scale(const step_plan& plan) const {
        const float colors = loss_->gradient_scale();
        return learns_depth(plan) ? std::max(colors, depth_weight(plan)) : colors;
    }

    /// Between the renderer's `list` and `blend`.
    void learn_depth(const step_plan& plan) {
        const photo& shot = train_[downscales_][plan.view];
        const std::size_t n = values_of(shot.camera);
        by_depths_.resize(n);
        renderer_.blend_depths();
        device_.for_each_index(
            n / 3, depth_gradient{renderer_.picture(), depths_.data() + shot.first_depth,
                                  depth_fits_[plan.view], depth_weight(plan), n / 3, by_depths_.data()});
        renderer_.backward_depths(by_depths_.data(), gradient_scale(plan), plan.gradient);
    }

    adam<float> descent(const step_plan& plan, const train::watch& watch) {
        ++steps_;
        const double by_first = 1 / (1 - std::pow(adam<float>::beta1, steps_));
        const double by_second = 1 / std::sqrt(1 - std::pow(adam<float>::beta2, steps_));
        adam<float> step{trained_.values.write(),
                         trained_.first.write(),
                         trained_.second.write(),
                         trained_.last_step.data(),
                         steps_,
                         {},
                         static_cast<float>(by_second),
                         renderer_.room(),
                         watch};
        for (std::size_t p = 0; p < parameter_count; ++p)
            step.rates[p] = static_cast<float>(plan.rates[p] * by_first);
        return step;
    }

    std::uint64_t all_pairs() {
        unsigned long long n = 0;
        device_.download(&n, renderer_.pairs(), 1);
        return n;
    }

    /// A picture of the whole model, whatever room it takes. Neither timed nor counted: it is no step.
    void draw(const camera& camera, const std::array<float, 3>& background, int sh_degree) {
        const std::uint64_t before = all_pairs();
        device_.pause_times(true);
        const float* backdrop = sky_.draw(camera);
        renderer_.forward(trained_.values.read(), count_, camera, sh_degree, background, backdrop);
        if (const std::uint64_t needed = renderer_.instances(); needed > renderer_.reserved_instances()) {
            renderer_.reserve_instances(needed, needed / 4);
            renderer_.forward(trained_.values.read(), count_, camera, sh_degree, background, backdrop);
        }
        device_.pause_times(false);
        drawn_pairs_ += all_pairs() - before;
    }

    std::vector<float> downloaded(const float* from, const camera& camera) {
        std::vector<float> picture(values_of(camera));
        device_.download(picture.data(), from, picture.size());
        return picture;
    }

    Device device_;
    raster::renderer<Device, float, raster::cut_for<typename Device::warp>, Accumulators> renderer_;
    image_comparison<Device, float> comparison_;
    std::unique_ptr<loss<float>> loss_;
    std::size_t losses_so_far_ = 0;
    train::exposures<Device> exposures_, test_exposures_;
    train::sky<Device> sky_;
    buffer<std::uint8_t> photos_;
    buffer<std::uint16_t> depths_;
    std::vector<depth_fit> depth_fits_;  ///< one a training view
    buffer<float> by_depths_;
    std::vector<std::vector<photo>> train_{1};  ///< by how often they were shrunk
    std::vector<photo> test_;
    buffer<glm::vec3> cameras_;  ///< where those to learn from were taken
    std::size_t downscales_ = 0;

    buffer<std::uint64_t> lengths_;        // of each training view's lists when it was last seen,
    std::vector<std::size_t> lengths_of_;  // and of how many Gaussians; none if it was not

    int sh_degree_ = 0;
    effect_set effects_;
    std::size_t count_ = 0;
    std::uint32_t steps_ = 0;
    std::uint64_t drawn_pairs_ = 0;
    trained_parameters<Device> trained_;
    densification<Device> densification_;
    buffer<raster::visibility> seen_;
    buffer<std::uint64_t> skipped_;
    buffer<watch::memory> found_;
    buffer<float> shown_;
};

}  // namespace gs::train
