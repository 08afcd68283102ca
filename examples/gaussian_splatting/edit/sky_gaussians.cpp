// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "../model/spherical_harmonics.hpp"
#include "../scene/normalization.hpp"
#include "edit.hpp"

namespace gs::edit {
namespace {

/// The distance of the sphere from the center of the model, in units of the distance within which
/// almost all Gaussians are. So the few Gaussians behind the sphere hardly matter.
constexpr double relative_radius = 4, almost_all = 0.999;
/// The standard deviation along the sphere, in units of the distance between neighbors, at which
/// less than a hundredth of the light passes between them.
constexpr double relative_deviation = 0.8;
constexpr float sky_opacity = 6;  // a logit

struct sphere {
    glm::dvec3 center{0};
    double radius = 1;
};

sphere sphere_around(const gaussians& model) {
    if (model.count() == 0) return {};
    const glm::dvec3 center = normalization_of(model).origin;
    std::vector<double> distances;
    for (std::size_t i = 0; i < model.count(); ++i)
        distances.push_back(glm::distance(
            center, glm::dvec3(model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2])));
    const auto last = distances.begin() +
                      static_cast<std::ptrdiff_t>(almost_all * static_cast<double>(distances.size() - 1));
    std::ranges::nth_element(distances, last);
    return {center, relative_radius * std::max(*last, normalization_of(model).scale)};
}

/// Returns directions with equal distances, on a Fibonacci spiral.
glm::dvec3 direction_of(std::size_t index) {
    const double z = 1 - (2 * static_cast<double>(index) + 1) / static_cast<double>(sky_count);
    const double angle = static_cast<double>(index) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
}

/// Returns the base color of a Gaussian that shows the sky of a direction.
glm::dvec3 color_of(const std::vector<float>& sky, const glm::dvec3& direction) {
    double basis[sh_coefficients(sky_degree)];
    sh_basis(sky_degree, direction, basis);
    glm::dvec3 color(0);
    for (int k = 0; k < sh_coefficients(sky_degree); ++k)
        for (int channel = 0; channel < 3; ++channel)
            color[channel] += basis[k] * sky[static_cast<std::size_t>(3 * k + channel)];
    return color / basis[0];
}

}  // namespace

gaussians with_sky_gaussians(gaussians model) {
    const std::vector<float> sky = std::exchange(model.sky, {});
    if (sky.empty()) return model;
    const sphere around = sphere_around(model);
    const double spacing = around.radius * std::sqrt(4 * std::numbers::pi / static_cast<double>(sky_count));
    const auto size = static_cast<float>(std::log(relative_deviation * spacing));
    const auto append = [](std::vector<float>& to, const auto&... values) {
        (to.push_back(static_cast<float>(values)), ...);
    };
    for (std::size_t i = 0; i < sky_count; ++i) {
        const glm::dvec3 direction = direction_of(i);
        const glm::dvec3 place = around.center + around.radius * direction;
        const glm::dvec3 color = color_of(sky, direction);
        append(model.mean, place.x, place.y, place.z);
        append(model.log_scale, size, size, size);
        append(model.quaternion, 1, 0, 0, 0);
        append(model.opacity, sky_opacity);
        append(model.sh_constant, color.x, color.y, color.z);
    }
    model.sh_rest.resize(model.count() * static_cast<std::size_t>(model.rest_width()), 0.0f);
    return model;
}

}  // namespace gs::edit
