// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "schedule.hpp"

#include <algorithm>
#include <cmath>

namespace gs::train {

int schedule::sh_degree_at(int iteration) const {
    return std::min(sh_degree, iteration / sh_degree_interval);
}

int schedule::downscales_at(int iteration) const {
    const int interval = resolution_interval();
    return interval > 0 ? std::max(0, num_downscales - (iteration - 1) / interval) : 0;
}

int schedule::resolution_interval() const {
    return resolution_schedule.value_or(iterations / (4 + std::max(1, num_downscales)));
}

std::array<float, 8> schedule::rates_at(int iteration) const {
    const double t = std::min(1.0, static_cast<double>(iteration) / iterations);
    const double mean =
        extent * std::exp(std::log(position_lr_init) * (1 - t) + std::log(position_lr_final) * t);
    const double sh = feature_lr, band = sh_rate();
    std::array<float, 8> rates{};
    std::ranges::transform(std::array{mean, scaling_lr, rotation_lr, opacity_lr, sh, band, band, band},
                           rates.begin(), [](double rate) { return static_cast<float>(rate); });
    return rates;
}

float schedule::exposure_rate_at(int iteration, int views) const {
    const double first = std::min(0.05, 1.5 * views / iterations);
    return static_cast<float>(first * std::pow(0.1, static_cast<double>(iteration) / iterations));
}

float schedule::sky_rate_at(int iteration) const {
    return static_cast<float>(0.01 * std::pow(0.01, static_cast<double>(iteration) / iterations));
}

float schedule::depth_weight_at(int iteration) const {
    return static_cast<float>(std::pow(0.01, static_cast<double>(iteration) / iterations));
}

int schedule::densify_until() const {
    return std::min(densify_until_iter.value_or(std::min(15000, iterations / 2)), iterations);
}

double schedule::growth_threshold() const {
    const double shorter = 15000.0 / std::clamp(densify_until(), 1, 15000);
    return densify_grad_threshold.value_or(8e-5 * std::pow(shorter, 0.25));
}

bool schedule::densifies(int iteration) const {
    return iteration > densify_from_iter && iteration < densify_until() &&
           iteration % densification_interval == 0;
}

double schedule::share_to_prune() const {
    const int first = (densify_from_iter / densification_interval + 1) * densification_interval;
    const bool grows = first < densify_until() && densify_until() < iterations;
    return prune_share.value_or(grows ? 0.2 : 0.0);
}

int schedule::prune_after(int views) const {
    const int until = densify_until();
    return share_to_prune() > 0 ? std::min(until + views, (until + iterations + 1) / 2) : 0;
}

int schedule::densifications_from(int iteration) const {
    const int first = std::max(iteration, densify_from_iter + 1);
    return (densify_until() - 1) / densification_interval - (first - 1) / densification_interval;
}

bool schedule::resets_opacity(int iteration) const {
    if (white && iteration == densify_from_iter) return iteration < densify_until();
    return iteration % opacity_reset_interval == 0 && iteration + opacity_reset_interval <= densify_until();
}

}  // namespace gs::train
