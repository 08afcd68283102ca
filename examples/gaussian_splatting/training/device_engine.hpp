// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "../engine/engine.hpp"
#include "../features/device_features.hpp"
#include "../metrics/image_comparison.hpp"
#include "../optimize/view_gradients.hpp"
#include "../render/renderer.hpp"
#include "clamp_render.hpp"
#include "device_views.hpp"
#include "drawn_views.hpp"
#include "engine_memory.hpp"
#include "engine_parts.hpp"
#include "list_sizer.hpp"
#include "pair_counter.hpp"
#include "rank_division.hpp"
#include "refine_pose.hpp"
#include "render_download.hpp"
#include "row_work.hpp"
#include "step_images.hpp"
#include "step_monitor.hpp"
#include "trained_sh.hpp"
#include "view_strips.hpp"

namespace gs::train {

/// The engine for a device. It determines the order of the kernels and owns the memory that they
/// share.
template <device::device Device, class Accumulators = raster::product_accumulators>
class device_engine final : public engine, device::profiler, learned_cameras, rank_member, checkpointed {
    using renderer_type =
        raster::renderer<Device, float, raster::cut_for<typename Device::warp>, Accumulators>;
    using step_type = features::step<renderer_type>;
    using photo = typename device_views<Device>::photo;
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit device_engine(engine_parts<Device> parts = {})
        : parts_(parts),
          renderer_(device_),
          comparison_(device_),
          features_(device_),
          images_(device_, renderer_, features_),
          gradients_(device_),
          pairs_(device_, renderer_),
          sh_(*this),
          views_(device_),
          lists_(device_),
          row_work_(device_),
          monitor_(device_),
          division_(device_, trained_, seen_),
          download_(device_),
          gather_(device_, division_.shares()) {
        profiler_ = this;
        state_ = this;
        cameras_ = this;
        ranks_ = this;
        start({});
    }

    void set_views(const std::vector<view>& train, const std::vector<view>& test, int downscales,
                   const photos::photo_plan& memory) override {
        views_.set(train, test, downscales, memory);
        photos_ = views_.cache();
        features_.set_views(train.size());
        set_level(0);
    }

    void set_model(const gaussians& model) override {
        sh_degree_ = model.sh_degree;
        effects_.antialiasing = model.antialiased;
        renderer_.set_effects(effects_);
        features_.set_model(model);
        gather_.release();
        renderer_.release_strips();
        trained_.set_values(device_, model);
        begin_generation(model.count());
        lists_.reset(views_.count());
        device_.wait();
        division_.reset();
        steps_ = 0;
    }

    gaussians get_model() override {
        division_.update();
        gaussians model = trained_.get_values(device_, count_, sh_degree_);
        model.antialiased = effects_.antialiasing;
        features_.get_model(model);
        return model;
    }

    void begin(const training_setup& setup) override {
        start(setup);
        monitor_.take_faults();
    }

    void reserve(int downscales) override {
        if (static_cast<std::size_t>(downscales) != level_) set_level(static_cast<std::size_t>(downscales));
        division_.divide(count_, renderer_);
        set_strip(trained_.shares ? std::optional<raster::view_strip>(raster::view_strip{}) : std::nullopt,
                  false);
        lists_.reserve(renderer_, trained_.values.read(), count_, views_.train(level_));
    }

    void step(const step_plan& plan, const std::vector<std::size_t>& more_views) override {
        division_.divide(count_, renderer_);
        trained_.require_memory(device_, count_, sh_degree_);
        std::vector<std::size_t> views{plan.view};
        views.insert(views.end(), more_views.begin(), more_views.end());
        std::vector<step_type> steps =
            images_.begin(plan, views, views_, views_.train(level_), setup_.facts.gradient);
        const raster::view_stack picture = step_images<renderer_type>::picture_of(steps);
        const auto strip = strips_.of_step(views, picture, loss_->reach(), device_.ranks(), shares());
        set_strip(strip, true);
        float scale = 0;
        for (step_type& s : steps) {
            if (strip) s.target.rows = picture.rows_of(s.place, strip->own_pixels(picture.height()));
            loss_->set_target(s.target);
            scale = std::max({scale, loss_->gradient_scale(), features_.gradient_scale(s)});
        }
        for (step_type& s : steps) s.gradient_scale = scale;
        device_.iteration(key_of(steps), [&] { iterate(steps, picture); });
        for (const step_type& s : steps) {
            lists_.was_noted(s.plan.view, count_);
            if (trained_.shares)
                row_work_.keep(s.plan.view, renderer_.row_work().subspan(s.place * picture.tiles_of_view()));
        }
        if (trained_.shares) {
            if (views.size() == 1)
                strips_.note_sent(plan.view, renderer_.exchange().window_counts(), *trained_.shares);
            division_.note_step(renderer_.exchange().drawn(), count_);
        }
        if (views_.cache() != nullptr) views_.cache()->upload_ahead();
    }

    std::uint64_t densify(int iteration) override {
        division_.update();
        division_.balance();
        auto views = drawn(views_.train(level_));
        const std::size_t most = largest_count();
        const densify_report report =
            strategy_->run(iteration, {in_training(), seen_.data(), gather_, views, most});
        begin_generation(report.count);
        division_.move(count_, sh_degree_, gather_);
        lacks_memory_ = report.count >= most && !move_sh_to_host();
        return report.without_gradient;
    }

    void adjust(int iteration) override {
        strategy_->adjust(iteration, in_training());
        division_.note_change();
    }

    step_report take_report() override {
        row_work_.take(strips_);
        division_.move_if_uneven(count_, sh_degree_, gather_);
        const std::uint64_t skipped = monitor_.skipped();
        const auto sums = loss_->sums();
        device_.sum_over_ranks(sums.data(), sums.size());
        pairs_.take_others();
        return {loss_->take(), skipped, monitor_.take_faults()};
    }

    feature_state& feature(std::string_view name) override {
        if (name == "direction") return sh_;
        return features_.named(name);
    }

    std::vector<float> render(const camera& camera, const std::array<float, 3>& background,
                              const render_options& options) override {
        const std::size_t planes = options.inverse_depth ? 1 : 3;
        renderer_.set_strip({});
        if (!options.separate_memory) {
            draw(renderer_, camera, background, options);
            return download_(renderer_.render(), planes, camera, options);
        }
        const std::size_t before = device_.used_bytes();
        if (!apart_) apart_.emplace(device_);
        apart_->set_effects(effects_);
        draw(*apart_, camera, background, options);
        bytes_apart_ += device_.used_bytes() - before;
        return download_(apart_->render(), planes, camera, options);
    }

    image_quality measure(std::size_t test_view, const std::array<float, 3>& background,
                          std::vector<float>* render) override {
        const photo& shot = views_.held_out()[test_view];
        renderer_.set_strip({});
        draw(renderer_, shot.camera, background);
        const float* exposed = features_.show_held_out(test_view, renderer_.render(), shot.pixels());
        shown_.resize(3 * shot.pixels());
        device_.for_each_index(shown_.size(), clamp_render{exposed, shown_.data()});
        comparison_.set_target(views_.load_in_order(views_.held_out(), test_view).target(background));
        comparison_.compare(shown_.data());
        if (render != nullptr) *render = download_(exposed, 3, shot.camera);
        return comparison_.take();
    }

  private:
    friend class trained_sh<device_engine>;

    /// Returns the training views of one size, to be rendered for scores.
    drawn_views<renderer_type> drawn(const std::vector<photo>& views) {
        division_.divide(count_, renderer_);
        return {device_,
                renderer_,
                views_,
                views,
                setup_.facts.gradient,
                trained_.shares,
                [this](std::size_t view, const photo& shot) {
                    set_strip(strips_.of({&view, 1}, shot.camera, 0, device_.ranks()), false);
                    draw(renderer_, features_.seen_by(view, shot.camera), {});
                }};
    }

    camera training_camera(std::size_t view, const camera& given) override {
        return features_.seen_by(view, given);
    }

    camera refined_camera(std::size_t test_view, const std::array<float, 3>& background) override {
        const photo& shot = views_.held_out()[test_view];
        renderer_.set_strip({});
        const auto loss = parts_.make_loss(device_, setup_.loss);
        const target_image target = views_.load_in_order(views_.held_out(), test_view).target(background);
        return refine_pose(device_, renderer_, features_, *loss, target, test_view, shot.camera,
                           setup_.facts.gradient,
                           [&](const camera& seen) { draw(renderer_, seen, background); });
    }

    void join(ranks::communicator& ranks) override { device_.join(ranks); }
    void prepare_renders() override {
        division_.update();
        if (trained_.shares) gather_.release();
        trained_.undivide_values(device_);
    }

    /// @name device::profiler
    /// @{
    std::string device_name() const override { return device_.name(); }
    void sample_times(int every) override { device_.sample_times(every); }
    device::stage_times times() override { return device_.times(); }
    std::uint64_t pairs() override { return pairs_.of_steps(); }
    std::size_t peak_device_bytes() const override { return device_.peak_bytes(); }
    bool shares_host_memory() const override { return Device::shares_host_memory; }
    std::size_t used_device_bytes() const override { return device_.used_bytes(); }
    std::size_t free_device_bytes() const override { return device_.free_bytes(); }
    device::memory_forecast forecast(std::size_t gaussians, int sh_degree) const override {
        device::memory_forecast all = forecast_of_gaussians<Device>(renderer_, count_, gaussians, sh_degree,
                                                                    setup_, division_.own_part(count_));
        all.photos = views_.photo_bytes();
        all.others += views_.most_pixels() * setup_.batch_size * bytes_per_pixel<Device, renderer_type>();
        return all;
    }
    void wait() override { device_.wait(); }
    /// @}

    /// Moves the SH coefficients of the highest degree on the device to host memory, with their moments.
    /// Returns false if there are none, or if the host has no room for them.
    bool move_sh_to_host() {
        parameter_storage next = setup_.storage;
        next.first_degree_on_host = std::min(next.first_degree_on_host, sh_degree_ + 1) - 1;
        if (next.first_degree_on_host < 1 ||
            count_ * bytes_per_gaussian(sh_degree_, next).on_host > setup_.host_bytes)
            return false;
        trained_.set_storage(device_, next);
        first_degree_on_host_ = next.first_degree_on_host;
        setup_.storage = next;
        return true;
    }
    /// Returns the largest number of Gaussians for which the limit of memory suffices, in all ranks.
    std::size_t largest_count() {
        std::uint64_t limit =
            growth_limit(count_, setup_.facts.max_device_bytes, device_.used_bytes() - bytes_apart_,
                         [&](std::size_t gaussians) { return forecast(gaussians, sh_degree_).total(); });
        device_.ranks().minimum(&limit, 1);
        return limit;
    }

    void exchange(state_archive& archive) override {
        const state_archive::scope scope(archive, "engine");
        archive.exchange("gaussians", count_);
        archive.exchange("sh_degree", sh_degree_);
        archive.exchange("steps", steps_);
        if (archive.loads()) {
            division_.divide_for_loading(count_);
        } else {
            division_.update();
            trained_.require_memory(device_, count_, sh_degree_);
        }
        trained_.exchange(archive, device_);
        exchange_buffer(archive, device_, "statistics", seen_);
        if (sh_degree_ < 0 || sh_degree_ > 3 || !trained_.fits(count_, sh_degree_) || seen_.size() != count_)
            throw error("the checkpoint has arrays that do not fit its number of Gaussians");
        exchange_lists(archive);
        pairs_.exchange(archive);
        features_.exchange(archive);
        const state_archive::scope strategy(archive, "strategy." + setup_.densification.name);
        strategy_->exchange(archive);
    }
    /// Saves or loads the size level and the lengths of tile lists. Measures the lists again if the
    /// sizes of the views differ from those of the checkpoint.
    void exchange_lists(state_archive& archive) {
        std::size_t level = level_;
        std::uint64_t capacity = renderer_.reserved_instances();
        archive.exchange("level", level);
        archive.exchange("list_capacity", capacity);
        level = std::min(level, views_.levels() - 1);  // the run may have fewer
        if (level != level_) set_level(level);
        std::vector<std::uint64_t> pixels;
        for (const photo& shot : views_.train(level_)) pixels.push_back(shot.pixels());
        const auto present_pixels = pixels;
        archive.exchange("pixels", pixels);
        if (pixels == present_pixels) {
            lists_.exchange(archive);
            if (archive.loads()) renderer_.reserve_instances(capacity);
        } else {
            lists_.reset(pixels.size());
            reserve(static_cast<int>(level_));
        }
    }

    void start(const training_setup& setup) {
        auto strategy = parts_.make_strategy(device_, setup.densification, setup.facts);
        if (const auto columns = strategy->gradient_columns(); !columns.empty())
            throw error("the densification strategy '" + setup.densification.name +
                        "' needs the gradient column '" + columns.front() +
                        "', which the backward pass does not sum: choose another strategy");
        loss_ = parts_.make_loss(device_, setup.loss);
        strategy_ = std::move(strategy);
        timetable_ = strategy_.get();
        features_.begin(setup);
        setup_ = setup;
        lists_.set_views_at_once(setup.batch_size);
        first_degree_on_host_ = setup.storage.first_degree_on_host;
        ++runs_;
        trained_.set_storage(device_, setup.storage);
    }

    void set_level(std::size_t level) {
        level_ = level;
        if (views_.cache() != nullptr) views_.cache()->set_level(level);
        lists_.reset(views_.train(level).size());
        strips_.reset(views_.train(level).size());
        row_work_.reset(views_.train(level));
    }

    /// Returns the Gaussians of each rank.
    ranks::shares shares() const { return trained_.shares.value_or(ranks::shares(count_, block_length, 1)); }
    /// Limits later draws to the strip of this rank.
    void set_strip(std::optional<raster::view_strip> strip, bool is_of_step) {
        if (strip) {
            strip->gaussians = shares();
            strip->is_of_step = is_of_step;
        }
        renderer_.set_strip(strip);
    }
    trained_gaussians<Device> in_training() {
        trained_.require_memory(device_, count_, sh_degree_);
        return {device_,    trained_,         count_,        trained_.own(device_, count_),
                sh_degree_, views_.centers(), views_.count()};
    }

    /// Sets the number of Gaussians and clears their statistics. Precondition: `trained_` has them.
    void begin_generation(std::size_t count) {
        count_ = count;
        seen_.resize(count);
        device_.zero(seen_.data(), count);
    }

    /// Returns the graph key: what determines the launches of `iterate`, their ranges and memory. It is
    /// empty for several views, for which the renderer waits.
    device::graph_key key_of(const std::vector<step_type>& steps) const {
        if (steps.size() > 1) return {};
        const step_type& s = steps[0];
        device::graph_key key{runs_,
                              count_,
                              renderer_.reserved_instances(),
                              static_cast<std::size_t>(s.camera.width),
                              static_cast<std::size_t>(s.camera.height),
                              static_cast<std::size_t>(s.camera.lens()),
                              s.target.masked ? std::size_t{1} : 0,
                              effects_.antialiasing ? std::size_t{1} : 0,
                              trained_.memory_key(),
                              strategy_->memory_key(s.plan.iteration)};
        features_.add_memory_keys(s, key);
        return key;
    }

    void iterate(std::vector<step_type>& steps, const raster::view_stack& picture) {
        const step_plan& plan = steps[0].plan;
        trained_.fetch(device_, picture);
        renderer_.list(trained_.values.read(), count_, picture, plan.sh_degree, dropout_of(plan));
        images_.learn_depths(steps, loss_->reach());
        renderer_.blend(plan.background, images_.background(steps));
        device_.begin(device::stage::loss);
        const float* gradient = images_.learn(steps, *loss_);
        const float* sums =
            renderer_.backward_to_splats(gradient, steps[0].gradient_scale, steps[0].accumulate);
        for (const step_type& s : steps) {
            if (steps.size() > 1) features_.seen_by(s.plan.view, views_.train(level_)[s.plan.view].camera);
            features_.learn_pose(s, sums);
        }
        trained_.descend(++steps_, plan.rates, renderer_.capacity(), monitor_.check_of(plan.iteration),
                         [&](const auto& step) { descend(steps, sums, step); });
        strategy_->after_step(plan.iteration, {in_training(), plan.rates, renderer_.capacity()});
        monitor_.close(renderer_, loss_->sums(), lists_.length(plan.view), plan.iteration);
        if (steps.size() > 1)
            for (const step_type& s : steps) lists_.note_mean(renderer_, s.plan.view);
    }
    /// Changes the Gaussians by the sum of the gradients of all views.
    template <class Adam>
    void descend(const std::vector<step_type>& steps, const float* sums, const Adam& descent) {
        const step_plan& plan = steps[0].plan;
        raster::visibility* seen = strategy_->wants(plan.iteration) ? seen_.data() : nullptr;
        const int learned_sh_degree = plan.updates_sh ? plan.sh_degree : 0;
        if (steps.size() == 1) return renderer_.backward_from_splats(sums, learned_sh_degree, descent, seen);
        const add_gradients all = gradients_.begin(trained_, count_, sh_degree_, renderer_.capacity());
        for (const step_type& s : steps)
            renderer_.backward_from_splats(sums, learned_sh_degree, all, seen, s.place);
        gradients_.step(descent, all, learned_sh_degree);
    }

    raster::dropout dropout_of(const step_plan& plan) const {
        counter_random random(setup_.facts.seed, static_cast<std::uint64_t>(plan.iteration), 0);
        return {setup_.dropout, static_cast<std::uint32_t>(random.below(std::uint64_t{1} << 32))};
    }

    /// Renders the model. Raises the capacity if the view has more instances. Waits for the device.
    /// The render is not timed or counted as a step.
    void draw(renderer_type& renderer, const camera& camera, const std::array<float, 3>& background,
              const render_options& options = {}) {
        const std::uint64_t before = pairs_.of_renders();
        device_.pause_times(true);
        const auto list = [&] {
            renderer.list(trained_.values.read(), count_, camera, std::min(options.sh_degree, sh_degree_));
        };
        list();
        if (const std::uint64_t required = renderer.instances(); required > renderer.reserved_instances()) {
            renderer.reserve_instances(required, required / 4);
            list();
        }
        if (options.inverse_depth)
            renderer.blend_depths();
        else
            renderer.blend(background, features_.background(camera));
        device_.pause_times(false);
        pairs_.leave_out_since(before);
    }

    engine_parts<Device> parts_;
    Device device_;
    renderer_type renderer_;
    image_comparison<Device, float> comparison_;
    features::device_features<renderer_type> features_;
    step_images<renderer_type> images_;
    view_gradients<Device> gradients_;
    pair_counter<renderer_type> pairs_;
    trained_sh<device_engine> sh_;
    device_views<Device> views_;
    list_sizer<Device> lists_;
    view_strips strips_;
    row_work<Device> row_work_;
    step_monitor<Device> monitor_;
    rank_division<Device> division_;
    render_download<Device> download_;
    parameter_gather<Device> gather_;
    std::unique_ptr<loss<float>> loss_;
    std::unique_ptr<strategy<Device>> strategy_;
    training_setup setup_;
    std::size_t runs_ = 0;   ///< number of calls of `start`, which may allocate
    std::size_t level_ = 0;  ///< size level: the training views are halved this many times

    int sh_degree_ = 0;
    effect_set effects_;
    std::uint32_t steps_ = 0;
    std::optional<renderer_type> apart_;  ///< see `render_options::separate_memory`
    std::size_t bytes_apart_ = 0;         ///< device memory that such renders have allocated
    trained_parameters<Device> trained_;
    buffer<raster::visibility> seen_;
    buffer<float> shown_;
};

}  // namespace gs::train
