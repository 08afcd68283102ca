// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../densify/growth/growth_end.hpp"

namespace gs::train {

int schedule::sh_degree_at(int iteration) const {
    return std::min(sh_degree, iteration / sh_degree_interval);
}

int schedule::downscales_at(int iteration) const {
    const int interval = resolution_interval();
    return interval > 0 ? std::max(0, num_downscales - (iteration - 1) / interval) : 0;
}

int schedule::resolution_interval() const {
    if (resolution_schedule) return *resolution_schedule;
    const std::int64_t growth_end = default_growth_end(iterations, views, transparent);
    const int n = std::max(1, num_downscales);
    return static_cast<int>(rendered ? 2 * growth_end / (4 + n) : 3 * growth_end * (3 * n - 1) / (5 * n * n));
}

double schedule::position_progress(int iteration) const {
    const double progress = iterations.progress(iteration);
    const int growth_end = default_growth_end(iterations, views, transparent);
    if (growth_end == iterations.milestone(0.5)) return progress;
    return std::max(progress, std::min(1.0, iteration / (2.0 * growth_end)));
}

std::array<float, 8> schedule::rates_at(int iteration) const {
    const double moved = position_progress(iteration);
    const double mean = extent * std::exp(std::log(position_rate_init()) * (1 - moved) +
                                          std::log(position_rate_final()) * moved);
    const double rest = std::pow(0.1, std::max(0.0, 5 * iterations.progress(iteration) - 4)), sh = feature_lr,
                 band = sh_rate();
    std::array<double, 8> all{mean, scaling_lr, rotation_lr, opacity_lr, sh, band, band, band};
    for (std::size_t p = 1; p < all.size(); ++p) all[p] *= rest;
    std::array<float, 8> rates{};
    std::ranges::transform(all, rates.begin(), [](double rate) { return static_cast<float>(rate); });
    return rates;
}

}  // namespace gs::train
