// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "../../model/opacity.hpp"
#include "../growth/growth.hpp"
#include "../hide_near_camera.hpp"
#include "../penalties.hpp"
#include "../strategy.hpp"
#include "adaptive_schedule.hpp"
#include "densify_kernels.hpp"

namespace gs::train {

/// Adaptive density control (Kerbl et al. 2023, section 5.2). At intervals it clones or splits
/// Gaussians with large gradients, removes transparent Gaussians, and resets opacities. After the
/// last densification it removes a share of the Gaussians. A penalty can lower the opacities of
/// Gaussians that no view needs in each step. `adaptive_schedule` has the timetable.
template <device::device Device>
class adaptive final : public strategy<Device> {
  public:
    using settings = adaptive_config;

    adaptive(Device& device, const adaptive_config& config, const training_facts& facts)
        : schedule_(config, facts), growth_(device), penalties_{schedule_.opacity_penalty()} {}

    bool wants(int iteration) const override { return schedule_.wants(iteration); }
    bool due(int iteration) const override { return schedule_.due(iteration); }
    int count_is_final_after() const override { return schedule_.count_is_final_after(); }

    void after_step(int iteration, const step_context<Device>& c) override {
        apply_penalties(penalties_, 1, iteration, c);
    }

    densify_report run(int iteration, const run_context<Device>& c) override {
        if (c.count == 0) return {};
        const growth_marks marks = growth_.begin(c);
        if (schedule_.densifies(iteration)) {
            densify_config config = schedule_.densify_config_at(iteration, c.count);
            config.limits.cap = std::min(config.limits.cap, c.most);
            c.device.for_each_index(c.count,
                                    classify{c.parameters.values.read(), c.statistics, config, marks});
            const auto tally = growth_.grow(c, config.limits);
            return {tally.count, tally.without_gradient};
        }
        c.device.for_each_index(c.count, rate_by_gradient{c.statistics, marks});
        return {growth_.remove(c, schedule_.number_to_prune(c.count)).count};
    }

    void adjust(int iteration, const trained_gaussians<Device>& g) override {
        const auto values = g.parameters.values.write();
        constexpr float reset_opacity = 0.01f;
        if (schedule_.resets_opacity(iteration))
            g.device.for_each_index(
                g.own, lower_opacity{values.opacity, g.parameters.moments(), logit(reset_opacity)});
        if (schedule_.hides_near_cameras(iteration)) hide_near_cameras(g);
    }

  private:
    adaptive_schedule schedule_;
    growth<Device> growth_;
    penalty_weights penalties_;
};

}  // namespace gs::train
