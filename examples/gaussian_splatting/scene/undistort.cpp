// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "undistort.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gs {
namespace {

glm::dvec2 to_ray(const camera& pinhole, glm::dvec2 pixel) {
    return {(pixel.x - pinhole.cx) / pinhole.fx, (pixel.y - pinhole.cy) / pinhole.fy};
}

glm::dvec2 to_photo(const camera& taken_with, const lens& distortion, glm::dvec2 ray) {
    const glm::dvec2 distorted = distortion.distort(ray);
    return {taken_with.fx * distorted.x + taken_with.cx, taken_with.fy * distorted.y + taken_with.cy};
}

/// Returns rays through the centers of pixels along the border, including the four pixels that are
/// nearest to the camera's axis. At these pixels and in the corners, the border of a distorted
/// photo reaches farthest inward and outward.
std::vector<glm::dvec2> border_rays(const camera& pinhole) {
    constexpr int steps = 64;
    const double left = 0.5, top = 0.5, right = pinhole.width - 0.5, bottom = pinhole.height - 0.5;
    std::vector<glm::dvec2> rays;
    const auto add_column = [&](double x) {
        rays.push_back(to_ray(pinhole, {x, top}));
        rays.push_back(to_ray(pinhole, {x, bottom}));
    };
    const auto add_row = [&](double y) {
        rays.push_back(to_ray(pinhole, {left, y}));
        rays.push_back(to_ray(pinhole, {right, y}));
    };
    for (int i = 0; i <= steps; ++i) {
        add_column(std::lerp(left, right, static_cast<double>(i) / steps));
        add_row(std::lerp(top, bottom, static_cast<double>(i) / steps));
    }
    add_column(std::clamp(pinhole.cx, left, right));
    add_row(std::clamp(pinhole.cy, top, bottom));
    return rays;
}

bool lies_inside(const camera& taken_with, glm::dvec2 pixel) {
    constexpr double rounding = 1e-9;
    return pixel.x >= 0.5 - rounding && pixel.x <= taken_with.width - 0.5 + rounding &&
           pixel.y >= 0.5 - rounding && pixel.y <= taken_with.height - 0.5 + rounding;
}

/// Returns whether the image plane between the axis and these rays lies inside the photo and does
/// not fold over.
bool photo_covers(const camera& taken_with, const lens& distortion, const std::vector<glm::dvec2>& rays,
                  double zoom) {
    constexpr int steps = 16;
    for (const glm::dvec2& ray : rays)
        for (int i = 1; i <= steps; ++i) {
            const glm::dvec2 inner = ray * (i / (steps * zoom));
            if (distortion.area_scale(inner) <= 0) return false;
            if (!lies_inside(taken_with, to_photo(taken_with, distortion, inner))) return false;
        }
    return true;
}

/// Clamps a value to [0, last]. Unlike `std::clamp`, it turns NaN into a number.
double into_range(double value, double last) { return std::fmin(std::fmax(value, 0.0), last); }

void sample(const image& photo, glm::dvec2 position, std::uint8_t* result) {
    const double x = into_range(position.x - 0.5, photo.width - 1.0);
    const double y = into_range(position.y - 0.5, photo.height - 1.0);
    const auto left = static_cast<std::size_t>(x), top = static_cast<std::size_t>(y);
    const std::size_t right = std::min(left + 1, static_cast<std::size_t>(photo.width) - 1);
    const std::size_t bottom = std::min(top + 1, static_cast<std::size_t>(photo.height) - 1);
    const double to_right = x - static_cast<double>(left), down = y - static_cast<double>(top);
    const std::size_t row = static_cast<std::size_t>(photo.width);
    for (std::size_t channel = 0; channel < 4; ++channel) {
        const auto at = [&](std::size_t column, std::size_t line) {
            return static_cast<double>(photo.rgba[4 * (line * row + column) + channel]);
        };
        const double above = std::lerp(at(left, top), at(right, top), to_right);
        const double below = std::lerp(at(left, bottom), at(right, bottom), to_right);
        result[channel] = static_cast<std::uint8_t>(std::lerp(above, below, down) + 0.5);
    }
}

}  // namespace

std::optional<camera> undistorted_camera(const camera& taken_with, const lens& distortion) {
    if (distortion.is_none()) return taken_with;
    const std::vector<glm::dvec2> rays = border_rays(taken_with);
    const auto fits = [&](double zoom) { return photo_covers(taken_with, distortion, rays, zoom); };
    double too_wide = 0.5, wide_enough = 5;  // inverses of COLMAP's limits for sizes: 2, 0.2
    if (!fits(wide_enough)) return std::nullopt;
    if (fits(too_wide)) wide_enough = too_wide;
    for (int i = 0; i < 48 && too_wide < wide_enough; ++i) {
        const double middle = std::midpoint(too_wide, wide_enough);
        (fits(middle) ? wide_enough : too_wide) = middle;
    }
    camera pinhole = taken_with;
    pinhole.fx *= wide_enough;
    pinhole.fy *= wide_enough;
    return pinhole;
}

image undistort(const image& photo, const camera& taken_with, const lens& distortion, const camera& wanted) {
    image result;
    result.width = wanted.width;
    result.height = wanted.height;
    result.has_alpha = photo.has_alpha;
    result.rgba.resize(std::size_t{4} * static_cast<std::size_t>(wanted.width) *
                       static_cast<std::size_t>(wanted.height));
    std::uint8_t* pixel = result.rgba.data();
    for (int y = 0; y < wanted.height; ++y)
        for (int x = 0; x < wanted.width; ++x, pixel += 4)
            sample(photo, to_photo(taken_with, distortion, to_ray(wanted, {x + 0.5, y + 0.5})), pixel);
    return result;
}

depth_map undistort(const depth_map& depths, const camera& taken_with, const lens& distortion,
                    const camera& wanted) {
    depth_map result{wanted.width, wanted.height, {}};
    for (int y = 0; y < wanted.height; ++y)
        for (int x = 0; x < wanted.width; ++x) {
            const glm::dvec2 at = to_photo(taken_with, distortion, to_ray(wanted, {x + 0.5, y + 0.5}));
            const auto column = static_cast<std::size_t>(into_range(at.x, depths.width - 1.0));
            const auto row = static_cast<std::size_t>(into_range(at.y, depths.height - 1.0));
            result.values.push_back(depths.values[row * static_cast<std::size_t>(depths.width) + column]);
        }
    return result;
}

}  // namespace gs
