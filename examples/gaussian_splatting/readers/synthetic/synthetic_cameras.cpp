// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_cameras.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <string>

#include "../../core/random.hpp"
#include "../../scene/look_at.hpp"

namespace gs {
namespace {

constexpr int view_count = 48;
constexpr double field_of_view = 45 * std::numbers::pi / 180;
constexpr double camera_distance = 3.3;

using vec = glm::dvec3;

/// Returns the i-th place on a spiral that turns by the golden angle. The places are spread evenly.
/// Neighbors in space have distant numbers, so every n-th place lies between others. The logarithms
/// of the distances are uniform from `how.distance` to `how.distance * how.scales`.
vec place_on_spiral(int i, const synthetic_parameters& how) {
    const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    const double lowest = std::sin(12 * std::numbers::pi / 180);
    const double highest = std::sin(76 * std::numbers::pi / 180);
    const double height = glm::mix(lowest, highest, (i + 0.5) / view_count);
    const double across = std::sqrt(1 - height * height);
    const double angle = golden_angle * i;
    const double farther = how.distance * std::pow(how.scales, std::fmod(i * std::numbers::sqrt2, 1.0));
    return farther * camera_distance * vec{across * std::cos(angle), across * std::sin(angle), height};
}

camera spiral_camera(int i, int size, const synthetic_parameters& how) {
    const vec eye = place_on_spiral(i, how);
    if (how.panorama > 0) {
        const double heading = i * std::numbers::sqrt3;
        const vec ahead{std::cos(heading), std::sin(heading), 0};
        const camera pose = look_at(eye, eye + ahead, {0, 0, 1}, size, size);
        camera c = camera::panorama(size, std::max(1, size / 2));
        c.rotation = pose.rotation;
        c.translation = pose.translation;
        return c;
    }
    const auto looking = [&](double radius) {
        return look_at(eye, vec{0}, {0, 0, 1}, size, 0.5 * size / radius);
    };
    if (how.fisheye == 0) return looking(std::tan(0.5 * field_of_view));
    const fisheye lens({0.02, -0.006, 0.001, -0.0001});  // similar to lenses of action cameras
    camera c = looking(lens.radius(how.fisheye * std::numbers::pi / 360));
    c.fisheye = lens;
    return c;
}

}  // namespace

std::vector<view> synthetic_views(int size, const synthetic_parameters& how) {
    std::vector<view> views(view_count);
    for (int i = 0; i < view_count; ++i) {
        view& v = views[static_cast<std::size_t>(i)];
        v.name = "view_" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".png";
        v.camera = spiral_camera(i, size, how);
    }
    return views;
}

void disturb_poses(std::vector<view>& views, std::size_t first, const synthetic_parameters& how) {
    if (how.poses == 0) return;
    for (std::size_t i = 0; i < views.size(); ++i) {
        train::counter_random random(0, 0, first + i);
        const auto direction = [&] { return glm::normalize(vec(random.normal3())); };
        camera& c = views[i].camera;
        const vec move = how.poses / 100 * camera_distance * how.distance * direction();
        const vec center = c.center() + move;
        c.rotation = glm::mat3_cast(glm::angleAxis(glm::radians(how.poses), direction())) * c.rotation;
        c.translation = -(c.rotation * center);
    }
}

void shake_cameras(std::vector<view>& views, const synthetic_parameters& how) {
    if (how.blur == 0 && how.shutter == 0) return;
    for (std::size_t i = 0; i < views.size(); ++i) {
        train::counter_random random(1, 0, i);
        const double heading = 2 * std::numbers::pi * random.uniform(), length = random.uniform();
        camera& c = views[i].camera;
        if (i % 4 == 0) continue;
        const double pixel = length * c.width / synthetic_size / c.fx;
        const vec more(random.normal3());
        c.motion = {pixel * vec{std::cos(heading), std::sin(heading), 0.5 * more.z},
                    0.1 * pixel * glm::length(c.translation) * vec{more.x, more.y, 0}, how.blur, how.shutter};
    }
}

camera at_time(const camera& moving, double time) {
    camera c = moving;
    const vec turn = time * moving.motion->turn;
    const double angle = glm::length(turn);
    const auto by = angle > 0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1, 0, 0, 0);
    c.rotation = glm::mat3_cast(by) * moving.rotation;
    c.translation = by * moving.translation + time * moving.motion->shift;
    return c;
}

double farthest_camera(const synthetic_parameters& how) {
    return camera_distance * how.distance * how.scales;
}

}  // namespace gs
