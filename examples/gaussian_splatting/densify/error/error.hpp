// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../core/random.hpp"
#include "../adaptive/adaptive_schedule.hpp"
#include "../growth/growth.hpp"
#include "../hide_near_camera.hpp"
#include "../penalties.hpp"
#include "../strategy.hpp"
#include "error_config.hpp"
#include "error_kernels.hpp"

namespace gs::train {

/// Densification where several training views show errors (Ren et al. 2025, "FastGS"). Each
/// growth renders some training views, compares them with their photos, and sums the weights of each
/// Gaussian in wrong pixels. It then clones and splits Gaussians that have large gradients and show
/// errors. After the last growth it removes the fifth of the Gaussians of which the views show least.
/// The model has fewer Gaussians than that of `adaptive`, whose timetable it shares.
///
/// Unlike in the paper, a pixel is wrong above a fixed error, and a Gaussian counts a pixel by its
/// weight.
template <device::device Device>
class error_driven final : public strategy<Device> {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    using settings = error_config;

    error_driven(Device& device, const error_config& config, const training_facts& facts)
        : device_(device), config_(config), facts_(facts), schedule_({}, facts), growth_(device) {}

    bool wants(int iteration) const override { return schedule_.wants(iteration); }
    bool due(int iteration) const override { return schedule_.due(iteration); }
    int count_is_final_after() const override { return schedule_.count_is_final_after(); }

    void after_step(int iteration, const step_context<Device>& c) override {
        apply_penalties({schedule_.opacity_penalty(), 0}, 1, iteration, c);
    }

    densify_report run(int iteration, const run_context<Device>& c) override {
        if (c.count == 0) return {};
        const growth_marks marks = growth_.begin(c);
        if (schedule_.densifies(iteration)) {
            score(iteration, static_cast<std::size_t>(config_.views), c);
            densify_config at = schedule_.densify_config_at(iteration, c.count);
            at.limits.cap = std::min(at.limits.cap, c.most);
            // Errors decide, too, so the gradient may be smaller.
            const error_limits limits{at.gradient / 2, static_cast<float>(config_.pixels), at.dense_scale,
                                      at.least_opacity};
            device_.for_each_index(c.count, classify_by_error{c.parameters.values.read(), c.statistics,
                                                              scores_.data(), limits, marks});
            const growth_tally tally = growth_.grow(c, at.limits);
            return {tally.count, tally.without_gradient};
        }
        score(iteration, c.views.count(), c);
        device_.for_each_index(c.count, rate_by_weight{scores_.data(), marks});
        return {growth_.remove(c, schedule_.number_to_prune(c.count)).count};
    }

    void adjust(int iteration, const trained_gaussians<Device>& g) override {
        if (schedule_.hides_near_cameras(iteration)) hide_near_cameras(g);
    }

  private:
    /// Scores the Gaussians in at most `most` training views, evenly spaced from a random one. Cost:
    /// a render and a blend backward pass for each.
    void score(int iteration, std::size_t most, const run_context<Device>& c) {
        scores_.resize(c.count);
        device_.zero(scores_.data(), c.count);
        const std::size_t views = c.views.count(), n = std::min(most, views);
        counter_random random(facts_.seed, static_cast<std::uint64_t>(iteration), 0);
        const auto first = static_cast<std::size_t>(random.below(views));
        for (std::size_t k = 0; k < n; ++k) score_view((first + k * views / n) % views, c);
        c.views.gather(ranks::shared_array::of(scores_.data(), block_length, c.count));
    }

    void score_view(std::size_t view, const run_context<Device>& c) {
        const drawn_view drawn = c.views.draw(view);
        const std::size_t pixels =
            static_cast<std::size_t>(drawn.target.width) * static_cast<std::size_t>(drawn.target.height);
        pixel_scores_.resize(3 * pixels);
        device_.for_each_index(pixels, score_pixels{drawn.target, drawn.render, pixels,
                                                    static_cast<float>(config_.level), pixel_scores_.data()});
        const float* sums = c.views.sum_scores(pixel_scores_.data());
        device_.for_each_index(c.own, add_error_score{drawn.tiles, sums, scores_.data()});
    }

    Device& device_;
    error_config config_;
    training_facts facts_;
    adaptive_schedule schedule_;
    growth<Device> growth_;
    buffer<error_score> scores_;
    buffer<float> pixel_scores_;
};

}  // namespace gs::train
