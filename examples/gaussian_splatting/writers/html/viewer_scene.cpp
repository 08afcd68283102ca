// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <utility>

#include "../../render/geometry/device_camera.hpp"
#include "html.hpp"

namespace gs {
namespace {

constexpr std::size_t most_views = 200;

glm::dvec3 mean_up(const std::vector<view>& views) {
    glm::dvec3 sum(0);
    for (const view& v : views) sum -= glm::row(v.camera.rotation, 1);
    const double length = glm::length(sum);
    return length > 1e-3 * static_cast<double>(views.size()) ? sum / length
                                                             : -glm::row(views.front().camera.rotation, 1);
}

/// Returns the upward direction. Photographers hold cameras level, so it is the direction that is
/// most perpendicular to the horizontal axes of all cameras. The mean of the cameras' own upward
/// axes would be tilted if all of them look down.
glm::dvec3 up_direction(const std::vector<view>& views) {
    const glm::dvec3 mean = mean_up(views);
    glm::dmat3 across(0);
    for (const view& v : views) {
        const glm::dvec3 right = glm::row(v.camera.rotation, 0);
        across += glm::outerProduct(right, right);
    }
    across /= static_cast<double>(views.size());
    // The power method finds the largest eigenvector of this matrix. Of nearly equal eigenvectors,
    // which few cameras have, it stays near the mean.
    const glm::dmat3 level = glm::dmat3(1) - across;
    glm::dvec3 up = mean;
    for (int i = 0; i < 200; ++i) up = glm::normalize(level * up);
    return glm::dot(up, mean) < 0 ? -up : up;
}

camera in_world(camera c, const normalization& n) {
    c.translation = -(c.rotation * n.to_world(c.center()));
    return c;
}

}  // namespace

pages::viewer_scene viewer_scene_of(const scene& scene, std::string title,
                                    const std::array<float, 3>& background) {
    const normalization& n = scene.normalization;
    pages::viewer_scene shown;
    shown.title = std::move(title);
    const std::size_t count = scene.train.size(), listed = std::min(count, most_views);
    for (std::size_t i = 0; i < listed; ++i)
        shown.views.push_back(in_world(scene.train[i * count / listed].camera, n));
    shown.up = up_direction(scene.train);
    shown.radius = n.scale * scene.extent();
    const auto looked_at = scene.looked_at();
    const camera& first = shown.views.front();
    shown.pivot = looked_at ? n.to_world(*looked_at)
                            : first.center() + shown.radius * glm::dvec3(glm::row(first.rotation, 2));
    shown.near_plane = n.scale * raster::near_plane;
    shown.background = background;
    return shown;
}

}  // namespace gs
