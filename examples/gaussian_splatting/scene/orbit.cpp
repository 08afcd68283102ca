// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "orbit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "../core/median.hpp"
#include "look_at.hpp"
#include "perspective.hpp"

namespace gs {
namespace {

constexpr double least_radius = 1e-3;  ///< in internal units

/// Returns a unit vector at a right angle to `up` that is close to `wished`, if possible.
glm::dvec3 horizontal(const glm::dvec3& wished, const glm::dvec3& up) {
    const auto projected = [&](const glm::dvec3& v) { return v - glm::dot(v, up) * up; };
    for (const glm::dvec3& v : {wished, glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)})
        if (const glm::dvec3 flat = projected(v); glm::length(flat) > least_radius)
            return glm::normalize(flat);
    return {0, 0, 1};
}

/// Returns the mean of the cameras' up vectors, or that of the first camera if they cancel out.
glm::dvec3 mean_up(const std::vector<view>& views) {
    const auto up_of = [](const view& v) { return -glm::transpose(v.camera.rotation)[1]; };
    glm::dvec3 sum(0);
    for (const view& v : views) sum += up_of(v);
    return glm::length(sum) > 0.1 * static_cast<double>(views.size()) ? glm::normalize(sum)
                                                                      : up_of(views.front());
}

glm::dvec3 center_of(const scene& scene) {
    if (const auto looked_at = scene.looked_at()) return *looked_at;
    glm::dvec3 sum(0);
    for (const view& v : scene.train) sum += v.camera.center();
    return sum / static_cast<double>(scene.train.size());
}

double field_of_view_of(const camera& c) {
    return c.width < c.height ? 2 * std::atan(0.5 * c.width / c.fx) : 2 * std::atan(0.5 * c.height / c.fy);
}

}  // namespace

camera orbit::camera_at(double turn, int width, int height_of_image) const {
    const double angle = 2 * std::numbers::pi * turn;
    const glm::dvec3 side = glm::cross(up, ahead);
    const glm::dvec3 from =
        center + radius * (std::cos(angle) * ahead + std::sin(angle) * side) + height * up;
    const double focal = 0.5 * std::min(width, height_of_image) / std::tan(0.5 * field_of_view);
    camera c = look_at(from, center, up, width, focal);
    c.height = height_of_image;
    c.cy = 0.5 * height_of_image;
    return c;
}

orbit orbit_of(const scene& scene) {
    orbit o;
    o.center = center_of(scene);
    o.up = mean_up(scene.train);
    std::vector<double> radii, heights;
    for (const view& v : scene.train) {
        const glm::dvec3 from = v.camera.center() - o.center;
        heights.push_back(glm::dot(from, o.up));
        radii.push_back(glm::length(from - heights.back() * o.up));
    }
    o.ahead = horizontal(scene.train.front().camera.center() - o.center, o.up);
    o.height = median(heights);
    o.radius = std::max(median(radii), least_radius);
    o.field_of_view = field_of_view_of(perspective_of(scene.train.front().camera));
    return o;
}

orbit orbit_of(const gaussians& model) {
    const std::size_t n = model.count();
    std::array<glm::dvec3, 2> quartiles;  // of the means; robust against floaters
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = model.mean[3 * i + static_cast<std::size_t>(axis)];
        std::ranges::sort(x);
        quartiles[0][axis] = x[n / 4];
        quartiles[1][axis] = x[n - 1 - n / 4];
    }
    const glm::dvec3 spread = quartiles[1] - quartiles[0];
    const int thin = spread.x < spread.y ? (spread.x < spread.z ? 0 : 2) : (spread.y < spread.z ? 1 : 2);
    const double distance = 2.5 * std::max(glm::length(spread), 1.0);
    orbit o;
    o.center = 0.5 * (quartiles[0] + quartiles[1]);
    o.up = o.ahead = glm::dvec3(0);
    o.up[thin] = 1;
    o.ahead[(thin + 1) % 3] = 1;
    o.radius = 0.9 * distance;
    o.height = 0.45 * distance;
    o.field_of_view = 2 * std::atan(0.5 / 1.2);
    return o;
}

}  // namespace gs
