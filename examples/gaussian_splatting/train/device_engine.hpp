// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../parallel.hpp"
#include "../raster/renderer.hpp"
#include "../scene/views.hpp"
#include "adam.hpp"
#include "densify.hpp"
#include "engine.hpp"
#include "photometric.hpp"
#include "watch.hpp"

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

/// Counts the steps that were left out, notes how long the lists were, and looks at the loss: one index.
struct close_step {
    raster::list_room room;
    std::uint64_t* skipped;
    std::uint64_t* length;  ///< of the view's lists
    const double* totals;   ///< of the loss
    train::watch watch;

    WARPAGG_HD void operator()(std::size_t) const {
        if (room.exceeded()) ++*skipped;
        *length = *room.needed;
        double sum = 0;
        for (int k = 0; k < loss_sum_count; ++k) sum += totals[k];
        if (!raster::is_finite(sum)) watch.note(fault::loss, 0, 0);
    }
};

/// An `engine` on a device: the order of the kernels, and the memory they share.
template <class Device>
class device_engine final : public engine {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using arrays = std::array<buffer<float>, parameter_count>;

  public:
    device_engine() : renderer_(device_), photometric_(device_) {
        skipped_.resize(1);
        device_.zero(skipped_.data(), 1);
        silent_.resize(1);
        found_.resize(1);
        device_.zero(found_.data(), 1);
        take_findings();
    }

    std::string device_name() const override { return device_.name(); }

    void set_views(const std::vector<view>& train, const std::vector<view>& test, int downscales) override {
        const auto levels = static_cast<std::size_t>(downscales);
        std::vector<std::vector<view>> shrunk(levels, std::vector<view>(train.size()));
        for_each_in_parallel(levels * train.size(), [&](std::size_t i) {
            const std::size_t level = i / train.size(), which = i % train.size();
            shrunk[level][which] = gs::shrunk(train[which], 2 << level);
        });
        std::size_t bytes = 0;
        const auto count = [&](const std::vector<view>& views) {
            for (const view& v : views) bytes += v.pixels.rgba.size();
        };
        count(train);
        count(test);
        for (const auto& views : shrunk) count(views);
        photos_.resize(bytes);
        bytes = 0;
        const auto put = [&](const std::vector<view>& views, std::vector<photo>& to) {
            to.clear();
            for (const view& v : views) {
                device_.upload(photos_.data() + bytes, v.pixels.rgba.data(), v.pixels.rgba.size());
                to.push_back({v.camera, bytes});
                bytes += v.pixels.rgba.size();
            }
        };
        train_.resize(1 + levels);
        put(train, train_[0]);
        for (std::size_t level = 0; level < levels; ++level) put(shrunk[level], train_[1 + level]);
        put(test, test_);
        lengths_.resize(train.size());
        set_downscales(0);
        device_.wait();
    }

    void set_model(const gaussians& model) override {
        sh_degree_ = model.sh_degree;
        resize(values_, model.count());
        resize(first_, model.count());
        resize(second_, model.count());
        const auto put = [&](parameter p, const std::vector<float>& from) {
            device_.upload(values_[index(p)].data(), from.data(), from.size());
        };
        put(parameter::mean, model.mean);
        put(parameter::log_scale, model.log_scale);
        put(parameter::quaternion, model.quaternion);
        put(parameter::opacity, model.opacity);
        put(parameter::sh0, model.sh_constant);
        for (int band = 1; band <= sh_degree_; ++band)
            put(static_cast<parameter>(static_cast<int>(parameter::sh0) + band), band_of(model, band));
        for (auto* moments : {&first_, &second_})
            for (auto& m : *moments) device_.zero(m.data(), m.size());
        device_.wait();
        begin_generation(model.count());
        std::ranges::fill(lengths_of_, 0);
        steps_ = 0;
    }

    gaussians get_model() override {
        gaussians model;
        model.sh_degree = sh_degree_;
        const auto get = [&](parameter p, std::vector<float>& to) {
            to.resize(values_[index(p)].size());
            device_.download(to.data(), values_[index(p)].data(), to.size());
        };
        get(parameter::mean, model.mean);
        get(parameter::log_scale, model.log_scale);
        get(parameter::quaternion, model.quaternion);
        get(parameter::opacity, model.opacity);
        get(parameter::sh0, model.sh_constant);
        const auto width = static_cast<std::size_t>(model.rest_width());
        model.sh_rest.resize(count_ * width);
        std::size_t at = 0;
        for (int band = 1; band <= sh_degree_; ++band) {
            std::vector<float> values;
            const auto p = static_cast<parameter>(static_cast<int>(parameter::sh0) + band);
            get(p, values);
            const auto w = static_cast<std::size_t>(parameter_width[index(p)]);
            for (std::size_t i = 0; i < count_; ++i)
                std::copy_n(values.data() + i * w, w, model.sh_rest.data() + i * width + at);
            at += w;
        }
        return model;
    }

    std::size_t count() const override { return count_; }

    void set_downscales(int times) override {
        downscales_ = static_cast<std::size_t>(times);
        lengths_of_.assign(train_[downscales_].size(), 0);
    }

    void step(const step_plan& plan) override {
        const gs::camera& camera = train_[downscales_][plan.view].camera;
        const device::iteration_shape shape{
            count_, renderer_.reserved_instances(), static_cast<std::size_t>(camera.width),
            static_cast<std::size_t>(camera.height), static_cast<std::size_t>(plan.gradient)};
        device_.iteration(shape, [&] { iterate(plan); });
        lengths_of_[plan.view] = count_;
    }

    std::uint64_t densify(const densify_rule& rule) override {
        if (count_ == 0) return 0;
        device_.zero(silent_.data(), 1);
        for (auto* b : {&copies_, &large_, &urgency_, &gaussian_of_}) b->resize(count_);
        device_.for_each_index(
            count_, judge_gaussians{read(values_), seen_.data(), rule, copies_.data(), large_.data(),
                                    urgency_.data(), gaussian_of_.data(), silent_.data()});
        const std::size_t staying = total_of_copies();
        const std::size_t room = rule.cap > staying ? rule.cap - staying : 0;
        device_.sort_pairs(urgency_, gaussian_of_, count_);
        device_.for_each_index(count_, let_grow{urgency_.data(), gaussian_of_.data(), room, copies_.data()});
        const std::size_t next = total_of_copies();

        origin_.resize(next);
        births_.resize(next);
        device_.for_each_index(count_, place_copies{copies_.data(), large_.data(), first_copy_.data(),
                                                    origin_.data(), births_.data()});
        for (std::size_t p = 0; p < parameter_count; ++p) {
            if (!has_parameter(p, sh_degree_)) continue;
            const auto width = static_cast<std::uint32_t>(parameter_width[p]);
            for (auto* spare : {&spare_value_, &spare_first_, &spare_second_}) spare->resize(next * width);
            device_.for_each_index(next * width,
                                   carry_over{origin_.data(), births_.data(), width, values_[p].data(),
                                              first_[p].data(), second_[p].data(), spare_value_.data(),
                                              spare_first_.data(), spare_second_.data()});
            std::swap(values_[p], spare_value_);
            std::swap(first_[p], spare_first_);
            std::swap(second_[p], spare_second_);
        }
        device_.for_each_index(next, part_halves{births_.data(), rule.seed, rule.step, write(values_)});
        begin_generation(next);
        unsigned long long silent = 0;
        device_.download(&silent, silent_.data(), 1);
        return silent;
    }

    void reset_opacity(float most) override {
        constexpr std::size_t p = index(parameter::opacity);
        device_.for_each_index(
            count_, lower_opacity{values_[p].data(), first_[p].data(), second_[p].data(), logit(most)});
    }

    void reserve() override {
        const std::vector<photo>& shots = train_[downscales_];
        for (std::size_t v = 0; v < shots.size(); ++v) {
            if (lengths_of_[v] > 0) continue;  // a step has seen it
            // It does not depend on colours: the least degree will do.
            renderer_.measure(read(values_), count_, shots[v].camera, 0);
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

    quality take_training_quality() override { return photometric_.take(); }

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

    std::vector<float> render(const camera& camera, const std::array<float, 3>& background) override {
        draw(camera, background);
        return drawn(camera);
    }

    quality measure(std::size_t test_view, const std::array<float, 3>& background,
                    std::vector<float>* picture) override {
        const photo& shot = test_[test_view];
        photometric_.take();  // what steps added
        draw(shot.camera, background);
        const std::size_t n = values_of(shot.camera);
        shown_.resize(n);
        device_.for_each_index(n, clamp_picture{renderer_.picture(), shown_.data()});
        photometric_.set_photo(photos_.data() + shot.first, shot.camera.width, shot.camera.height,
                               background);
        photometric_.compare(shown_.data());
        if (picture != nullptr) *picture = drawn(shot.camera);
        return photometric_.take();
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
    };

    static constexpr std::size_t index(parameter p) { return static_cast<std::size_t>(p); }
    static std::size_t values_of(const camera& c) {
        return 3 * static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    }

    static std::vector<float> band_of(const gaussians& model, int band) {
        const auto width = static_cast<std::size_t>(model.rest_width());
        const auto from = static_cast<std::size_t>(3 * (sh_coefficients(band - 1) - 1));
        const auto to = static_cast<std::size_t>(3 * (sh_coefficients(band) - 1));
        std::vector<float> values;
        values.reserve(model.count() * (to - from));
        for (std::size_t i = 0; i < model.count(); ++i)
            values.insert(values.end(), model.sh_rest.begin() + static_cast<std::ptrdiff_t>(i * width + from),
                          model.sh_rest.begin() + static_cast<std::ptrdiff_t>(i * width + to));
        return values;
    }

    void resize(arrays& a, std::size_t count) {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (has_parameter(p, sh_degree_))
                a[p].resize(count * static_cast<std::size_t>(parameter_width[p]));
    }
    template <class Real>
    static parameter_arrays<Real> pointers(const arrays& a) {
        return {a[0].data(),
                a[1].data(),
                a[2].data(),
                a[3].data(),
                {a[4].data(), a[5].data(), a[6].data(), a[7].data()}};
    }
    static parameter_arrays<const float> read(const arrays& a) { return pointers<const float>(a); }
    static parameter_arrays<float> write(arrays& a) { return pointers<float>(a); }

    /// `values_` and the moments hold `count` Gaussians that nobody has seen.
    void begin_generation(std::size_t count) {
        count_ = count;
        resize(gradients_, count);
        seen_.resize(count);
        device_.zero(seen_.data(), count);
    }

    std::size_t total_of_copies() {
        first_copy_.resize(count_ + 1);
        device_.prefix_sum(copies_, first_copy_, count_);
        std::uint64_t total = 0;
        device_.download(&total, first_copy_.data() + count_, 1);
        return total;
    }

    void iterate(const step_plan& plan) {
        using device::stage;
        const photo& shot = train_[downscales_][plan.view];
        renderer_.forward(read(values_), count_, shot.camera, plan.sh_degree, plan.background);
        device_.begin(stage::loss);
        photometric_.set_photo(photos_.data() + shot.first, shot.camera.width, shot.camera.height,
                               plan.background);
        const float* by_picture =
            photometric_.gradient(renderer_.picture(), plan.ssim_weight, renderer_.room());
        renderer_.backward(by_picture, plan.gradient, plan.updates_sh ? plan.sh_degree : 0, write(gradients_),
                           plan.watch ? seen_.data() : nullptr);
        device_.begin(stage::adam);
        descend(plan);
    }

    void descend(const step_plan& plan) {
        const train::watch watch{found_.data(), static_cast<std::uint32_t>(plan.iteration)};
        ++steps_;
        const double by_first = 1 / (1 - std::pow(adam<float>::beta1, steps_));
        const double by_second = 1 / std::sqrt(1 - std::pow(adam<float>::beta2, steps_));
        for (std::size_t p = 0; p < parameter_count; ++p) {
            if (!has_parameter(p, plan.updates_sh ? plan.sh_degree : 0)) continue;
            const auto width = static_cast<std::uint32_t>(parameter_width[p]);
            device_.for_each_element(
                count_ * width,
                adam<float>{values_[p].data(), first_[p].data(), second_[p].data(), gradients_[p].data(),
                            static_cast<float>(plan.rates[p] * by_first), static_cast<float>(by_second),
                            renderer_.room(), watch, static_cast<std::uint32_t>(p), width});
        }
        device_.for_each_index(1, close_step{renderer_.room(), skipped_.data(), lengths_.data() + plan.view,
                                             photometric_.totals(), watch});
    }

    std::uint64_t all_pairs() {
        unsigned long long n = 0;
        device_.download(&n, renderer_.pairs(), 1);
        return n;
    }

    /// A picture of the whole model, whatever room it takes. Neither timed nor counted: it is no step.
    void draw(const camera& camera, const std::array<float, 3>& background) {
        const std::uint64_t before = all_pairs();
        device_.pause_times(true);
        renderer_.forward(read(values_), count_, camera, sh_degree_, background);
        if (const std::uint64_t needed = renderer_.instances(); needed > renderer_.reserved_instances()) {
            renderer_.reserve_instances(needed, needed / 4);
            renderer_.forward(read(values_), count_, camera, sh_degree_, background);
        }
        device_.pause_times(false);
        drawn_pairs_ += all_pairs() - before;
    }

    std::vector<float> drawn(const camera& camera) {
        std::vector<float> picture(values_of(camera));
        device_.download(picture.data(), renderer_.picture(), picture.size());
        return picture;
    }

    Device device_;
    raster::renderer<Device, float> renderer_;
    photometric<Device, float> photometric_;
    buffer<std::uint8_t> photos_;
    std::vector<std::vector<photo>> train_;  ///< by how often they were shrunk
    std::vector<photo> test_;
    std::size_t downscales_ = 0;

    buffer<std::uint64_t> lengths_;        // of each training view's lists when it was last seen,
    std::vector<std::size_t> lengths_of_;  // and of how many Gaussians; none if it was not

    int sh_degree_ = 0;
    std::size_t count_ = 0;
    int steps_ = 0;
    std::uint64_t drawn_pairs_ = 0;
    arrays values_, first_, second_, gradients_;
    buffer<raster::visibility> seen_;
    buffer<std::uint64_t> skipped_;
    buffer<watch::memory> found_;
    buffer<float> shown_;

    // What `densify` works with.
    buffer<std::uint32_t> copies_, large_, urgency_, gaussian_of_, origin_;
    buffer<birth> births_;
    buffer<std::uint64_t> first_copy_;
    buffer<unsigned long long> silent_;
    buffer<float> spare_value_, spare_first_, spare_second_;
};

}  // namespace gs::train
