// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_falloff.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/vec3.hpp>

#include "../core/parallel.hpp"
#include "image_radius.hpp"

namespace gs {
namespace {

constexpr float one_size = 1.6f;  ///< of footprints: see `keep_one_size`
constexpr std::size_t least_observations = 5;

/// Observations of points, by sample.
struct lens_samples {
    fit_groups groups;
    value_column square_radius;
    std::array<value_column, 4> by_side;  ///< `square_radius` of a side, zero for samples of other sides
    std::array<value_column, 4> y;        ///< logarithms of red, green, blue and their mean
};

/// Returns the index in `lens_falloff::sides` of a place relative to the principal point.
std::size_t side_of(double x, double y) {
    return std::abs(x) > std::abs(y) ? (x > 0 ? 0u : 1u) : (y > 0 ? 2u : 3u);
}

lens_samples samples_of(const scene& of, observed_points& points) {
    lens_samples made;
    made.groups.photos = of.train.size();
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return of.train[o.view].camera.is_panorama; });
        keep_one_size(seen, one_size);
        if (seen.size() < least_observations) continue;
        const std::size_t first = made.square_radius.size();
        for (const observation& o : seen) {
            const camera& c = of.train[o.view].camera;
            made.groups.constant.push_back(o.view);
            made.square_radius.push_back(square_radius(c, o.place.x, o.place.y));
            const std::size_t own_side = side_of(o.place.x - c.cx, o.place.y - c.cy);
            for (std::size_t side = 0; side < 4; ++side)
                made.by_side[side].push_back(side == own_side ? made.square_radius.back() : 0);
            std::array<double, 3> direction{};
            double sum = 0;
            for (int k = 0; k < 3; ++k) {
                const auto i = static_cast<std::size_t>(k);
                made.y[i].push_back(std::log(static_cast<double>(o.color[k])));
                direction[i] = static_cast<double>(o.direction[k]);
                sum += static_cast<double>(o.color[k]);
            }
            made.y[3].push_back(std::log(sum / 3));
            made.groups.direction.push_back(direction);
        }
        made.groups.points.emplace_back(first, made.square_radius.size());
    }
    return made;
}

std::vector<std::pair<double, double>> profile_of(const lens_samples& samples, const regression<1>& fitted) {
    constexpr double least_weight = 20;  // of the observations of a tenth
    struct tenth {
        double weight = 0, radius = 0, log = 0;
    };
    std::array<tenth, 10> tenths;
    for (std::size_t i = 0; i < samples.square_radius.size(); ++i) {
        const double u = samples.square_radius[i], radius = std::sqrt(u), w = fitted.weights[i];
        tenth& t = tenths[std::min<std::size_t>(static_cast<std::size_t>(10 * radius), 9)];
        t.weight += w;
        t.radius += w * radius;
        t.log += w * (fitted.residuals[i] - fitted.strengths[0].value * u);
    }
    std::vector<std::pair<double, double>> profile;
    for (const tenth& t : tenths)
        if (t.weight >= least_weight) profile.emplace_back(t.radius / t.weight, std::exp(t.log / t.weight));
    return profile;
}

}  // namespace

bool lens_falloff::is_strong() const {
    return strength.value >= least_strength && strength.value >= least_errors * strength.error;
}

bool lens_falloff::is_clear() const {
    const auto agrees = [&](const estimated& test) {
        return test.value + test_errors * test.error >= least_agreement * strength.value;
    };
    return is_strong() && std::ranges::all_of(sides, [&](const estimated& side) { return agrees(side); }) &&
           agrees(for_direction);
}

std::array<double, 3> lens_falloff::at(double square_radius) const {
    std::array<double, 3> factors;
    for (std::size_t c = 0; c < 3; ++c) factors[c] = std::exp(-channels[c] * square_radius);
    return factors;
}

lens_falloff estimate_falloff(const scene& of, observed_points points) {
    lens_falloff found;
    const lens_samples samples = samples_of(of, points);
    found.points = samples.groups.points.size();
    if (samples.square_radius.empty()) return found;
    const std::array<value_column, 1> alone{samples.square_radius};
    const auto fitted = [&](std::size_t channel) {
        return fit<1>(samples.groups, samples.y[channel], alone);
    };
    const auto fit_all = [&] {
        const regression<1> all = fitted(3);
        found.strength = all.strengths[0];
        found.profile = profile_of(samples, all);
    };
    const std::array<std::function<void()>, 6> fits{
        [&] { found.for_direction = fit<4>(samples.groups, samples.y[3], alone).strengths[0]; },
        [&] { found.sides = fit<1>(samples.groups, samples.y[3], samples.by_side).strengths; },
        fit_all,
        [&] { found.channels[0] = fitted(0).strengths[0].value; },
        [&] { found.channels[1] = fitted(1).strengths[0].value; },
        [&] { found.channels[2] = fitted(2).strengths[0].value; }};
    for_each_in_parallel(fits.size(), [&](std::size_t i) { fits[i](); });
    return found;
}

void remove_falloff(const scene& of, const lens_falloff& falloff, observed_points& points) {
    for (auto& seen : points)
        for (observation& o : seen) {
            const camera& c = of.train[o.view].camera;
            if (c.is_panorama) continue;
            const auto factors = falloff.at(square_radius(c, o.place.x, o.place.y));
            for (int k = 0; k < 3; ++k)
                o.color[k] /= static_cast<float>(factors[static_cast<std::size_t>(k)]);
        }
}

}  // namespace gs
