// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "schedule.hpp"

#include <algorithm>
#include <cmath>

namespace gs::train {

int schedule::sh_degree_at(int iteration) const {
    return std::min(sh_degree, iteration / sh_degree_interval);
}

std::array<float, 8> schedule::rates_at(int iteration) const {
    constexpr double first = 1.6e-4, last = 1.6e-6;
    const double t = std::min(1.0, static_cast<double>(iteration) / iterations);
    const double mean = extent * std::exp(std::log(first) * (1 - t) + std::log(last) * t);
    constexpr float scale = 5e-3f, rotation = 1e-3f, opacity = 2.5e-2f, sh = 2.5e-3f;
    return {static_cast<float>(mean), scale, rotation, opacity, sh, sh / 20, sh / 20, sh / 20};
}

int schedule::densify_until() const { return std::min(15000, iterations / 2); }

bool schedule::densifies(int iteration) const {
    return iteration > densify_from && iteration < densify_until() && iteration % densify_every == 0;
}

bool schedule::resets_opacity(int iteration) const {
    if (iteration >= densify_until()) return false;
    return iteration % opacity_reset_every == 0 || (white && iteration == densify_from);
}

}  // namespace gs::train
