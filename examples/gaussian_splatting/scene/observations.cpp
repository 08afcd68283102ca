// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "observations.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "../core/parallel.hpp"
#include "view_photo.hpp"

namespace gs {
namespace {

constexpr std::size_t most_points = 6000;
constexpr double spacings = 2.5;                  ///< points this close may hide each other
constexpr double nearer = 0.03;                   ///< relative difference in depth
constexpr int least_value = 6, most_value = 249;  ///< of a channel that is not saturated

/// Returns whether the photo shows the surroundings of these pixel coordinates.
bool is_inside(const camera& c, double x, double y) {
    return x >= 2 && y >= 2 && x < c.width - 2 && y < c.height - 2;
}

std::vector<place_in_photo> project(const camera& c, const std::vector<colored_point>& points) {
    std::vector<place_in_photo> seen;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto p = c.see(points[i].position);
        if (p && is_inside(c, p->x, p->y))
            seen.push_back({static_cast<std::uint32_t>(i), p->x, p->y, p->depth});
    }
    return seen;
}

/// The depth of the nearest point in each cell of the image. The side of a cell is the distance, in
/// pixels, at which points may hide each other.
class nearest_depths {
  public:
    nearest_depths(const camera& c, const std::vector<place_in_photo>& seen)
        : cell_(std::max(2.0, spacings * std::sqrt(double(c.width) * c.height / double(seen.size() + 1)))),
          across_(static_cast<int>(c.width / cell_) + 3),
          depth_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(c.height / cell_ + 3),
                 std::numeric_limits<double>::infinity()) {
        for (const place_in_photo& p : seen) {
            double& d = depth_[at(p.x, p.y, 0, 0)];
            d = std::min(d, p.depth);
        }
    }
    /// Returns whether no point in this cell and its neighbors is clearly nearer.
    bool shows(const place_in_photo& p) const {
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                if (depth_[at(p.x, p.y, dx, dy)] < (1 - nearer) * p.depth) return false;
        return true;
    }

  private:
    std::size_t at(double x, double y, int dx, int dy) const {
        return static_cast<std::size_t>((static_cast<int>(y / cell_) + 1 + dy) * across_ +
                                        static_cast<int>(x / cell_) + 1 + dx);
    }

    double cell_;
    int across_;
    std::vector<double> depth_;
};

/// Observes the 3×3 pixels around this one.
std::optional<observation> look(const image& photo, int column, int row) {
    const auto pixel = [&](int x, int y) {
        return &photo.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(photo.width) +
                                static_cast<std::size_t>(x))];
    };
    float least = 1, most = 0;
    observation o;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const std::uint8_t* rgba = pixel(column + dx, row + dy);
            if (rgba[3] != 255) return std::nullopt;
            for (int c = 0; c < 3; ++c) {
                if (rgba[c] < least_value || rgba[c] > most_value) return std::nullopt;
                o.color[c] += static_cast<float>(rgba[c]) / (9 * 255);
            }
            const float brightness = static_cast<float>(rgba[0] + rgba[1] + rgba[2]) / 765;
            least = std::min(least, brightness);
            most = std::max(most, brightness);
        }
    o.roughness = (most - least) / most;
    return o;
}

}  // namespace

void keep_one_size(std::vector<observation>& seen, float factor) {
    std::ranges::sort(seen, {}, [](const observation& o) { return std::pair(o.footprint, o.view); });
    std::size_t first = 0, most = 0;
    for (std::size_t i = 0, end = 0; i < seen.size(); ++i) {
        while (end < seen.size() && seen[end].footprint <= factor * seen[i].footprint) ++end;
        if (end - i > most) {
            most = end - i;
            first = i;
        }
    }
    seen = {seen.begin() + static_cast<std::ptrdiff_t>(first),
            seen.begin() + static_cast<std::ptrdiff_t>(first + most)};
}

std::vector<place_in_photo> points_in_sight(const camera& camera, const std::vector<colored_point>& points) {
    std::vector<place_in_photo> seen = project(camera, points);
    const nearest_depths depths(camera, seen);
    std::erase_if(seen, [&](const place_in_photo& p) { return !depths.shows(p); });
    return seen;
}

point_observer::point_observer(const scene& of)
    : scene_(of), step_(of.points.size() / most_points + 1), by_view_(of.train.size()) {}

void point_observer::observe(std::size_t v, const image& photo, const camera& taken_with) {
    for (const place_in_photo& p : in_sight(taken_with))
        if (const auto o = look(photo, static_cast<int>(p.x), static_cast<int>(p.y)))
            keep(v, p, *o, taken_with);
}

void point_observer::observe_patches(std::size_t v, std::span<const place_in_photo> points,
                                     const image& patches, const camera& taken_with) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const auto o = look(patches, 1, static_cast<int>(3 * i + 1))) keep(v, points[i], *o, taken_with);
}

std::vector<place_in_photo> point_observer::in_sight(const camera& camera) const {
    std::vector<place_in_photo> points = points_in_sight(camera, scene_.points);
    std::erase_if(points, [this](const place_in_photo& p) { return p.point % step_ != 0; });
    points.shrink_to_fit();
    return points;
}

void point_observer::keep(std::size_t v, const place_in_photo& p, observation o, const camera& taken_with) {
    o.view = static_cast<std::uint32_t>(v);
    o.point = p.point;
    o.place = {p.x, p.y};
    o.direction = glm::vec3(glm::normalize(scene_.points[p.point].position - taken_with.center()));
    o.footprint = static_cast<float>(p.depth / std::sqrt(taken_with.fx * taken_with.fy));
    by_view_[v].emplace_back(p.point / static_cast<std::uint32_t>(step_), o);
}

observed_points point_observer::observations() const {
    observed_points by_point(scene_.points.size() / step_ + 1);
    for (const auto& seen : by_view_)
        for (const auto& [point, o] : seen) by_point[point].push_back(o);
    return by_point;
}

observed_points observe_points(const scene& of, std::span<const camera> cameras) {
    point_observer observer(of);
    for_each_in_parallel(of.train.size(), [&](std::size_t v) {
        observer.observe(v, view_photo(of.train[v]).pixels(), cameras[v]);
    });
    return observer.observations();
}

observed_points observe_points(const scene& of) {
    std::vector<camera> cameras;
    for (const view& v : of.train) cameras.push_back(v.camera);
    return observe_points(of, cameras);
}

}  // namespace gs
