// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "normalization.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "../core/median.hpp"
#include "scene.hpp"

namespace gs {
namespace {

/// Returns the median of `measure` over all `things`.
template <class Things, class Measure>
double median_of(const Things& things, const Measure& measure) {
    std::vector<double> values;
    values.reserve(things.size());
    for (const auto& thing : things) values.push_back(measure(thing));
    return median(values);
}

glm::dvec3 mean_of_cameras(const scene& s) {
    glm::dvec3 mean(0);
    for (const view& v : s.train) mean += v.camera.center() / static_cast<double>(s.train.size());
    return mean;
}

glm::dvec3 mean_of(const gaussians& model, std::size_t i) {
    return {model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2]};
}

/// Applies `change` to each mean and adds `shift` to each log scale.
template <class Change>
gaussians moved(gaussians model, const Change& change, double shift) {
    for (std::size_t i = 0; i < model.count(); ++i) {
        const glm::dvec3 mean = change(mean_of(model, i));
        for (glm::length_t axis = 0; axis < 3; ++axis)
            model.mean[3 * i + static_cast<std::size_t>(axis)] = static_cast<float>(mean[axis]);
    }
    for (float& s : model.log_scale) s = static_cast<float>(static_cast<double>(s) + shift);
    return model;
}

}  // namespace

double scene::extent() const {
    if (train.empty()) return 0;
    const glm::dvec3 mean = mean_of_cameras(*this);
    double farthest = 0;
    for (const view& v : train) farthest = std::max(farthest, glm::distance(mean, v.camera.center()));
    double depth = 0;
    if (!points.empty())
        depth = median_of(points, [&](const colored_point& p) { return glm::distance(mean, p.position); });
    else if (const auto point = looked_at())
        depth = glm::distance(mean, *point);
    if (farthest > 1e-6 * depth && farthest > 0) return 1.1 * farthest;
    return depth > 0 ? depth : 1 / normalization.scale;
}

std::optional<glm::dvec3> scene::looked_at() const {
    if (train.empty()) return std::nullopt;
    if (std::ranges::any_of(train, [](const view& v) { return v.camera.is_panorama; })) return std::nullopt;
    // Uses positions relative to the cameras, so that a distant origin costs no precision.
    const glm::dvec3 mean = mean_of_cameras(*this), origin = normalization.to_internal(glm::dvec3(0)) - mean;
    constexpr double pull = 1e-10;  // above rounding, below the effect of axes 0.01 degrees apart
    const auto axis_of = [](const camera& c) { return glm::transpose(c.rotation)[2]; };
    glm::dmat3 normal(pull);
    glm::dvec3 right = pull * origin;
    for (const view& v : train) {
        const glm::dvec3 axis = axis_of(v.camera);
        const glm::dmat3 across =
            (glm::dmat3(1) - glm::outerProduct(axis, axis)) / static_cast<double>(train.size());
        normal += across;
        right += across * (v.camera.center() - mean);
    }
    const glm::dvec3 point = glm::inverse(normal) * right;
    const double depth = median_of(train, [&](const view& v) {
        return glm::dot(axis_of(v.camera), point - (v.camera.center() - mean));
    });
    // A nearer point results only from the pull toward the origin.
    if (!(depth > 100 * pull * glm::length(origin))) return std::nullopt;
    return mean + point;
}

normalization normalization_of(const scene& scene) {
    const double scale = scene.extent() / internal_extent;
    return {mean_of_cameras(scene), std::isnormal(scale) ? scale : 1};
}

normalization normalization_of(const gaussians& model) {
    std::vector<std::size_t> all(model.count());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    normalization found;
    for (glm::length_t axis = 0; axis < 3; ++axis)
        found.origin[axis] = median_of(all, [&](std::size_t i) { return mean_of(model, i)[axis]; });
    const double distance = median_of(all, [&](std::size_t i) {
        const auto first = model.log_scale.begin() + static_cast<std::ptrdiff_t>(3 * i);
        const double size = std::exp(static_cast<double>(*std::max_element(first, first + 3)));
        return glm::distance(mean_of(model, i), found.origin) + size;
    });
    if (std::isnormal(distance)) found.scale = distance;
    return found;
}

void normalize(scene& scene, const log_function& log) {
    const normalization n = normalization_of(scene);
    for (auto* views : {&scene.train, &scene.test})
        for (view& v : *views)
            v.camera.translation = (v.camera.rotation * n.origin + v.camera.translation) / n.scale;
    for (colored_point& p : scene.points) p.position = n.to_internal(p.position);
    constexpr double farthest = 1e9;
    const std::size_t dropped = std::erase_if(
        scene.points, [](const colored_point& p) { return !(glm::length(p.position) <= farthest); });
    if (dropped > 0)
        log("dropped " + std::to_string(dropped) + " of " + std::to_string(scene.points.size() + dropped) +
            " points, whose distance is over a billion times that between the cameras");
    scene.normalization = n;
}

gaussians to_internal(const normalization& normalization, gaussians world) {
    return moved(
        std::move(world), [&](const glm::dvec3& p) { return normalization.to_internal(p); },
        -std::log(normalization.scale));
}

gaussians to_world(const normalization& normalization, gaussians internal) {
    return moved(
        std::move(internal), [&](const glm::dvec3& p) { return normalization.to_world(p); },
        std::log(normalization.scale));
}

}  // namespace gs
