// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "adaptive_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../growth/growth_end.hpp"

namespace gs::train {

int adaptive_schedule::count_is_final_after() const { return std::max(densify_until(), prune_after()); }

bool adaptive_schedule::densifies(int iteration) const {
    return iteration > config_.densify_from_iter && iteration < densify_until() &&
           iteration % config_.densification_interval == 0;
}

int adaptive_schedule::densify_until() const {
    const int by_default = default_growth_end(facts_.iterations, facts_.views, facts_.transparent);
    return std::min(config_.densify_until_iter.value_or(by_default), facts_.iterations.last());
}

densify_config adaptive_schedule::densify_config_at(int iteration, std::size_t gaussians) const {
    densify_config config;
    config.dense_scale = static_cast<float>(0.01 * facts_.extent);
    config.gradient = static_cast<float>(growth_threshold());
    config.least_opacity = config_.least_opacity;
    config.limits.cap = facts_.max_gaussians;
    if (config_.budget) {
        const std::size_t budget = *config_.budget;
        const auto left = static_cast<std::size_t>(densifications_from(iteration));
        config.gradient = 0;
        config.limits.cap = std::min(config.limits.cap, budget);
        config.limits.most_births = budget > gaussians ? (budget - gaussians + left - 1) / left : 0;
    }
    config.limits.revised_opacity = config_.revised_opacity;
    return config;
}

double adaptive_schedule::growth_threshold() const {
    const double shorter = 15000.0 / std::clamp(densify_until(), 1, 15000);
    const double mean_pixels = static_cast<double>(facts_.pixels) / std::max(1, facts_.views);
    const double larger = std::clamp(mean_pixels / 600000, 1.0, 4.0);
    return config_.densify_grad_threshold.value_or(8e-5 * std::pow(shorter, 0.25) * std::sqrt(larger));
}

int adaptive_schedule::densifications_from(int iteration) const {
    const int first = std::max(iteration, config_.densify_from_iter + 1);
    return (densify_until() - 1) / config_.densification_interval -
           (first - 1) / config_.densification_interval;
}

double adaptive_schedule::share_to_prune() const {
    const int interval = config_.densification_interval;
    const int first = (config_.densify_from_iter / interval + 1) * interval;
    const bool grows = first < densify_until() && densify_until() < facts_.iterations.last();
    if (!grows || config_.budget) return config_.prune_share.value_or(0.0);
    const int left = facts_.iterations.last() - densify_until();
    const double by_time = 1 - 0.8 * std::cbrt(3500.0 / left);
    return config_.prune_share.value_or(facts_.transparent ? std::clamp(by_time, 0.2, 0.6) : 0.2);
}

int adaptive_schedule::prune_after() const {
    if (share_to_prune() == 0) return 0;
    const int until = densify_until();
    const iteration_plan& plan = facts_.iterations;
    return std::min(until + facts_.views, plan.milestone((plan.progress(until + 1) + 1) / 2));
}

bool adaptive_schedule::resets_opacity(int iteration) const {
    const int interval = config_.opacity_reset_interval;
    if (facts_.white && iteration == config_.densify_from_iter) return iteration < densify_until();
    return iteration % interval == 0 && iteration + interval <= densify_until();
}

}  // namespace gs::train
