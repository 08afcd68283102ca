// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_shifts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "../core/median.hpp"
#include "../core/parallel.hpp"
#include "observations.hpp"
#include "view_photo.hpp"

namespace gs {
namespace {

constexpr std::size_t most_compared = 600;  ///< points of a photo
constexpr double largest_shift = 0.05;      ///< in widths or heights of the photo, whichever is larger
constexpr int smallest_reach = 3, largest_reach = 40;
constexpr double least_correlation = 0.3;
constexpr double agreement = 1.5;  ///< of two halves of the points, in pixels

/// The brightness of a photo: the mean of 3×3 pixels. Negative where a pixel is masked or transparent.
class smooth_brightness {
  public:
    explicit smooth_brightness(const image& photo) : width_(photo.width), values_(photo.rgba.size() / 4, -1) {
        for (int y = 1; y + 1 < photo.height; ++y)
            for (int x = 1; x + 1 < photo.width; ++x) values_[index(x, y)] = mean_around(photo, x, y);
    }
    float at(int x, int y) const { return values_[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    float mean_around(const image& photo, int x, int y) const {
        int sum = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const std::uint8_t* rgba = &photo.rgba[4 * index(x + dx, y + dy)];
                if (rgba[3] != 255) return -1;
                sum += rgba[0] + rgba[1] + rgba[2];
            }
        return static_cast<float>(sum) / (9 * 765);
    }

    int width_;
    std::vector<float> values_;
};

/// The sums from which a correlation follows.
struct moments {
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double x, double y) {
        n += 1;
        a += x;
        b += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    moments operator+(const moments& other) const {
        return {n + other.n, a + other.a, b + other.b, aa + other.aa, bb + other.bb, ab + other.ab};
    }
    /// Returns zero if there are few points, whose correlation may be chance.
    double correlation() const {
        constexpr double least = photo_shifts::least_points / 2;  // half of the points
        const double scale = (n * aa - a * a) * (n * bb - b * b);
        return n >= least && scale > 0 ? (n * ab - a * b) / std::sqrt(scale) : 0;
    }
};

struct point_in_photo {
    int x, y;
    double brightness;  ///< of the point, in any unit
};

/// The correlation between points and photo for each shift of up to `radius` pixels in x and y.
class correlations {
  public:
    correlations(int radius, const std::vector<moments>& of_shifts) : radius_(radius) {
        for (const moments& m : of_shifts) {
            // The log-likelihood that brightness is linear in that of points, relative to none. A shift that
            // moves points out of the photo's opaque part correlates fewer of them, maybe by chance.
            const double r = std::clamp(m.correlation(), 0.0, 1 - 1e-9);
            values_.push_back(-m.n * std::log1p(-r * r));
        }
        const auto best = static_cast<std::size_t>(std::ranges::max_element(values_) - values_.begin());
        highest_ = of_shifts[best].correlation();
        x_ = static_cast<int>(best) % across() - radius_;
        y_ = static_cast<int>(best) / across() - radius_;
    }
    /// Returns the best shift. Interpolates between pixels.
    glm::dvec2 best() const {
        return {x_ + vertex(at(x_ - 1, y_), at(x_, y_), at(x_ + 1, y_)),
                y_ + vertex(at(x_, y_ - 1), at(x_, y_), at(x_, y_ + 1))};
    }
    /// Returns whether all shifts around the best one are worse.
    bool has_peak() const { return std::max(std::abs(x_), std::abs(y_)) < radius_; }
    /// Returns the correlation of the best shift.
    double highest() const { return highest_; }

  private:
    int across() const { return 2 * radius_ + 1; }
    double at(int x, int y) const {
        x = std::clamp(x, -radius_, radius_);
        y = std::clamp(y, -radius_, radius_);
        return values_[static_cast<std::size_t>((y + radius_) * across() + x + radius_)];
    }
    /// Returns the place of the vertex of a parabola through the values at -1, 0 and 1.
    static double vertex(double before, double middle, double after) {
        const double curvature = before - 2 * middle + after;
        return curvature < 0 ? std::clamp((before - after) / (2 * curvature), -0.5, 0.5) : 0;
    }

    int radius_, x_, y_;
    double highest_;
    std::vector<double> values_;
};

/// Returns a sample of the points in sight whose surroundings are in the photo.
std::vector<point_in_photo> points_to_compare(const std::vector<colored_point>& all, const camera& c,
                                              int radius) {
    std::vector<place_in_photo> seen = points_in_sight(c, all);
    std::erase_if(seen, [&](const place_in_photo& p) {
        return p.x < radius + 1 || p.y < radius + 1 || p.x >= c.width - radius - 1 ||
               p.y >= c.height - radius - 1;
    });
    const std::size_t step = std::max<std::size_t>((seen.size() + most_compared - 1) / most_compared, 1);
    std::vector<point_in_photo> points;
    for (std::size_t i = 0; i < seen.size(); i += step) {
        const auto& color = all[seen[i].point].color;
        points.push_back(
            {static_cast<int>(seen[i].x), static_cast<int>(seen[i].y), double(color.r + color.g + color.b)});
    }
    return points;
}

}  // namespace

std::size_t photo_shifts::judged() const {
    return static_cast<std::size_t>(std::ranges::count_if(photos, &photo_shift::is_judged));
}

double photo_shifts::median_shift() const {
    std::vector<double> lengths;
    for (const photo_shift& p : photos)
        if (p.is_judged) lengths.push_back(glm::length(p.pixels));
    return lengths.empty() ? 0 : median(lengths);
}

photo_shift measure_shift(const std::vector<colored_point>& of, const camera& c, const image& photo) {
    const int radius = std::clamp(static_cast<int>(largest_shift * std::max(c.width, c.height)),
                                  smallest_reach, largest_reach);
    const std::vector<point_in_photo> points = points_to_compare(of, c, radius);
    if (points.size() < photo_shifts::least_points) return {};
    const smooth_brightness light(photo);
    std::array<std::vector<moments>, 2> halves;
    std::vector<moments> all;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            std::array<moments, 2> sums;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const float seen = light.at(points[i].x + dx, points[i].y + dy);
                if (seen >= 0) sums[i % 2].add(points[i].brightness, static_cast<double>(seen));
            }
            for (std::size_t half = 0; half < 2; ++half) halves[half].push_back(sums[half]);
            all.push_back(sums[0] + sums[1]);
        }
    const correlations whole(radius, all), first(radius, halves[0]), second(radius, halves[1]);
    return {whole.has_peak() && whole.highest() >= least_correlation &&
                std::min(first.highest(), second.highest()) > 0 &&
                glm::length(first.best() - second.best()) <= agreement,
            whole.best()};
}

photo_shifts measure_shifts(const scene& of, std::size_t most_photos) {
    photo_shifts found{std::vector<photo_shift>(of.train.size())};
    const std::size_t step = std::max<std::size_t>((of.train.size() + most_photos - 1) / most_photos, 1);
    found.examined = (of.train.size() + step - 1) / step;
    for_each_in_parallel(found.examined, [&](std::size_t i) {
        const view& v = of.train[i * step];
        found.photos[i * step] = measure_shift(of.points, v.camera, view_photo(v).pixels());
    });
    return found;
}

}  // namespace gs
