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
    return resolution_schedule.value_or(iterations.milestone(1.0 / (4 + std::max(1, num_downscales))));
}

std::array<float, 8> schedule::rates_at(int iteration) const {
    const double t = iterations.progress(iteration);
    const double mean =
        extent * std::exp(std::log(position_rate_init()) * (1 - t) + std::log(position_rate_final()) * t);
    const double sh = feature_lr, band = sh_rate();
    std::array<float, 8> rates{};
    std::ranges::transform(std::array{mean, scaling_lr, rotation_lr, opacity_lr, sh, band, band, band},
                           rates.begin(), [](double rate) { return static_cast<float>(rate); });
    return rates;
}

}  // namespace gs::train
