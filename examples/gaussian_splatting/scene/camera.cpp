// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace gs {
namespace {

/// Returns the derivative of `fisheye::radius`.
double slope(const std::array<double, 4>& k, double angle) {
    const double w = angle * angle;
    return 1 + w * (3 * k[0] + w * (5 * k[1] + w * (7 * k[2] + w * 9 * k[3])));
}

/// Returns the position between `from` and `to` where a condition stops holding. Precondition: it
/// holds at `from` and does not hold at `to`.
template <class Condition>
double bisect(double from, double to, const Condition& holds) {
    for (int i = 0; i < 60; ++i) {
        const double middle = std::midpoint(from, to);
        (holds(middle) ? from : to) = middle;
    }
    return from;
}

}  // namespace

fisheye::fisheye(const std::array<double, 4>& k) : k_(k), end_(widest) {
    constexpr int steps = 300;  // finer than any bend of a valid lens
    const auto grows = [&](double t) { return slope(k, t) > 0; };
    for (int i = 1; i <= steps && end_ == widest; ++i)
        if (!grows(widest * i / steps)) end_ = bisect(widest * (i - 1) / steps, widest * i / steps, grows);
}

double fisheye::radius(double angle) const {
    const double w = angle * angle;
    return angle * (1 + w * (k_[0] + w * (k_[1] + w * (k_[2] + w * k_[3]))));
}

double fisheye::angle(double radius) const {
    if (radius >= this->radius(end_)) return end_;
    // Newton's method. Bisects if a step would leave the bracket.
    double low = 0, high = end_, angle = std::min(radius, end_);
    for (int step = 0; step < 60; ++step) {
        const double off = this->radius(angle) - radius;
        (off > 0 ? high : low) = angle;
        const double tangent = angle - off / slope(k_, angle);
        const double next = tangent >= low && tangent <= high ? tangent : std::midpoint(low, high);
        if (std::abs(next - angle) <= 1e-15 * angle) return next;
        angle = next;
    }
    return angle;
}

camera camera::panorama(int width, int height) {
    camera c{width, height};
    c.is_panorama = true;
    c.fx = 0.5 * width / std::numbers::pi;
    c.fy = height / std::numbers::pi;
    c.cx = 0.5 * width;
    c.cy = 0.5 * height;
    return c;
}

std::optional<camera::image_point> camera::see(const glm::dvec3& point) const {
    const glm::dvec3 p = rotation * point + translation;
    if (is_panorama) {
        if (p == glm::dvec3(0)) return std::nullopt;
        const double longitude = std::atan2(p.x, p.z), latitude = std::atan2(p.y, std::hypot(p.x, p.z));
        return image_point{fx * longitude + cx, fy * latitude + cy, glm::length(p)};
    }
    if (!fisheye) {
        if (p.z <= 0) return std::nullopt;
        return image_point{fx * p.x / p.z + cx, fy * p.y / p.z + cy, p.z};
    }
    const double across = std::hypot(p.x, p.y), angle = std::atan2(across, p.z);
    if (p == glm::dvec3(0) || angle >= fisheye->end()) return std::nullopt;
    const double out = across > 0 ? fisheye->radius(angle) / across : 0;
    return image_point{fx * out * p.x + cx, fy * out * p.y + cy, glm::length(p)};
}

glm::dvec3 camera::ray(double x, double y) const {
    const glm::dvec2 place((x - cx) / fx, (y - cy) / fy);
    glm::dvec3 in_camera(place, 1);
    if (fisheye) {
        const double out = glm::length(place), angle = fisheye->angle(out);
        in_camera = {(out > 0 ? std::sin(angle) / out : 1) * place, std::cos(angle)};
    }
    if (is_panorama) {
        const double level = std::cos(place.y);
        in_camera = {level * std::sin(place.x), std::sin(place.y), level * std::cos(place.x)};
    }
    return glm::normalize(glm::transpose(rotation) * in_camera);
}

camera camera::resized(int new_width, int new_height) const {
    const double x = static_cast<double>(new_width) / width;
    const double y = static_cast<double>(new_height) / height;
    camera result = *this;
    result.width = new_width;
    result.height = new_height;
    result.fx *= x;
    result.cx *= x;
    result.fy *= y;
    result.cy *= y;
    return result;
}

}  // namespace gs
