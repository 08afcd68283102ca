// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "pose_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>

#include "../core/median.hpp"
#include "../core/solve.hpp"
#include "observations.hpp"

namespace gs {
namespace {

constexpr int smallest_level = 64;             ///< of a photo, in pixels
constexpr int steps_per_size = 5;              ///< at each size
constexpr std::size_t least_differences = 30;  ///< of a step
constexpr double least_deviation = 1e-4;       ///< of colors
constexpr double half_weight = 1;              ///< deviations at which a residual has half of its weight
constexpr double independent = 0.1;            ///< share of residuals that are independent of their neighbors
constexpr std::size_t pose_size = 6;           ///< a turn and a shift: see `moved_in_camera_space`

/// The changes of a point's place in the image, in pixels, by each number of a pose.
using place_change = std::array<glm::dvec2, pose_size>;

/// Returns nothing at the ends of a lens or of a panorama.
std::optional<place_change> change_at(const camera& c, const glm::dvec3& position) {
    camera eye = c;
    eye.rotation = glm::dmat3(1);
    eye.translation = glm::dvec3(0);
    const glm::dvec3 q = c.rotation * position + c.translation;
    const double step = 1e-4 * glm::length(q);
    std::array<glm::dvec2, 3> by_q;
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 off(0);
        off[k] = step;
        const auto after = eye.see(q + off), before = eye.see(q - off);
        if (!after || !before || std::abs(after->x - before->x) > 0.5 * c.width) return std::nullopt;
        by_q[static_cast<std::size_t>(k)] =
            glm::dvec2(after->x - before->x, after->y - before->y) / (2 * step);
    }
    // A turn moves q by its cross product with q.
    return place_change{q.y * by_q[2] - q.z * by_q[1],
                        q.z * by_q[0] - q.x * by_q[2],
                        q.x * by_q[1] - q.y * by_q[0],
                        by_q[0],
                        by_q[1],
                        by_q[2]};
}

/// Returns the rotation vector of a rotation by a small angle.
glm::dvec3 turn_of(const glm::dmat3& r) {
    return 0.5 * glm::dvec3(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
}

glm::dvec3 color_of(const colored_point& p) { return glm::dvec3(p.color) / 255.0; }

/// Gauss-Newton steps at one size of a photo.
class pose_steps {
  public:
    pose_steps(const photo_levels::level& photo, const std::vector<colored_point>& all,
               const std::vector<std::uint32_t>& points, const camera& start)
        : photo_(photo), camera_(start.resized(photo.width, photo.height)) {
        std::vector<shown_color> shown;
        for (const std::uint32_t p : points) {
            const auto change = change_at(camera_, all[p].position);
            if (!change) continue;
            points_.push_back({all[p].position, color_of(all[p]), *change});
            const auto place = camera_.see(all[p].position);
            const auto seen = place ? photo.colors.at(place->x, place->y) : std::nullopt;
            if (seen) shown.push_back({p, seen->color});
        }
        tone_ = fit_tone(shown, all);
    }

    /// Takes a step, unless the photo shows few of the points.
    void take(const camera& given, const pose_errors& errors) {
        std::vector<difference> differences;
        std::vector<double> sizes;
        for (const tracked& p : points_) {
            const auto place = camera_.see(p.position);
            const auto seen = place ? photo_.colors.at(place->x, place->y) : std::nullopt;
            if (!seen) continue;
            differences.push_back({&p, *seen, tone_.gain * p.color + tone_.offset - seen->color});
            sizes.push_back(glm::length(differences.back().color));
        }
        if (differences.size() < least_differences) return;
        // The length of a vector of three normal numbers has a median of 1.54 standard deviations.
        const double deviation = std::max(median(sizes), least_deviation) / 1.54;
        equations e;
        for (const difference& d : differences) {
            const double size = glm::length(d.color) / (1.54 * half_weight * deviation);
            e.add(d, 1 / ((1 + size * size) * deviation * deviation));
        }
        e.hold(camera_, given, errors);
        const auto x = e.solved();
        camera_ = moved_in_camera_space(camera_, {x[0], x[1], x[2]}, {x[3], x[4], x[5]});
        tone_.gain += glm::dvec3(x[6], x[7], x[8]);
        tone_.offset += glm::dvec3(x[9], x[10], x[11]);
    }
    const camera& result() const { return camera_; }

  private:
    struct tracked {
        glm::dvec3 position, color;
        place_change change;  ///< at the start
    };
    struct difference {
        const tracked* point;
        smooth_colors::sample seen;
        glm::dvec3 color;
    };

    /// The normal equations. The unknowns are a pose, gains and offsets.
    class equations {
      public:
        void add(const difference& d, double weight) {
            for (int k = 0; k < 3; ++k) {
                const auto channel = static_cast<std::size_t>(k);
                std::array<double, size> row{};
                for (std::size_t i = 0; i < pose_size; ++i)
                    row[i] = d.seen.by_x[k] * d.point->change[i].x + d.seen.by_y[k] * d.point->change[i].y;
                row[pose_size + channel] = -d.point->color[k];
                row[pose_size + 3 + channel] = -1;
                for (std::size_t i = 0; i < size; ++i) {
                    for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * row[i] * row[j];
                    right_[i] += weight * row[i] * d.color[k];
                }
            }
        }
        /// Adds the distance from the given pose.
        void hold(const camera& now, const camera& given, const pose_errors& errors) {
            const glm::dmat3 r = now.rotation * glm::transpose(given.rotation);
            const glm::dvec3 turn = turn_of(r), shift = now.translation - r * given.translation;
            const auto hold_at = [&](std::size_t i, double value, double error) {
                const double weight = 1 / (independent * error * error);
                matrix_[i][i] += weight;
                right_[i] -= weight * value;
            };
            for (int k = 0; k < 3; ++k) {
                hold_at(static_cast<std::size_t>(k), turn[k], errors.turn);
                hold_at(static_cast<std::size_t>(k) + 3, shift[k], errors.shift);
            }
        }
        std::array<double, pose_size + 6> solved() {
            constexpr double damping = 1e-3;  // keeps tones finite if all colors are alike
            for (std::size_t i = 0; i < size; ++i) matrix_[i][i] *= 1 + damping;
            return solve(matrix_, right_);
        }

      private:
        static constexpr std::size_t size = pose_size + 6;
        std::array<std::array<double, size>, size> matrix_{};
        std::array<double, size> right_{};
    };

    const photo_levels::level& photo_;
    camera camera_;
    std::vector<tracked> points_;
    photo_tone tone_;
};

}  // namespace

photo_levels::photo_levels(image photo) {
    while (true) {
        const int width = photo.width, height = photo.height;
        levels_.push_back({width, height, smooth_colors(photo)});
        if (std::max(width, height) < 2 * smallest_level || std::min(width, height) < 2) break;
        photo = downsample(photo, width / 2, height / 2);
    }
    std::ranges::reverse(levels_);
}

camera moved_in_camera_space(camera c, const glm::dvec3& turn, const glm::dvec3& shift) {
    const double angle = glm::length(turn);
    const glm::dmat3 r = angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, turn / angle)) : glm::dmat3(1);
    c.rotation = r * c.rotation;
    c.translation = r * c.translation + shift;
    return c;
}

camera turned_to(const camera& c, const std::vector<colored_point>& points, const glm::dvec2& pixels) {
    std::array<std::array<double, 3>, 3> matrix{};
    std::array<double, 3> right{};
    for (const place_in_photo& p : points_in_sight(c, points)) {
        const auto change = change_at(c, points[p.point].position);
        if (!change) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += glm::dot((*change)[i], (*change)[j]);
            right[i] += glm::dot((*change)[i], pixels);
        }
    }
    // A small penalty on the turn, by which a few points in one place determine it, too.
    const double penalty = 1e-6 * (matrix[0][0] + matrix[1][1] + matrix[2][2]) + 1e-12;
    for (std::size_t i = 0; i < 3; ++i) matrix[i][i] += penalty;
    const auto turn = solve(matrix, right);
    return moved_in_camera_space(c, {turn[0], turn[1], turn[2]}, glm::dvec3(0));
}

photo_tone fit_tone(const std::vector<shown_color>& shown, const std::vector<colored_point>& all) {
    constexpr int rounds = 4;
    photo_tone tone;
    if (shown.empty()) return tone;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> weights(shown.size(), 1.0), sizes(shown.size());
        for (int round = 0; round < rounds; ++round) {
            double n = 0, x = 0, y = 0, xx = 0, xy = 0;
            for (std::size_t i = 0; i < shown.size(); ++i) {
                const double w = weights[i], a = color_of(all[shown[i].point])[k], b = shown[i].color[k];
                n += w;
                x += w * a;
                y += w * b;
                xx += w * a * a;
                xy += w * a * b;
            }
            const double spread = n * xx - x * x;
            tone.gain[k] = spread > 1e-9 * n * n ? std::clamp((n * xy - x * y) / spread, 0.1, 10.0) : 1;
            tone.offset[k] = (y - tone.gain[k] * x) / n;
            for (std::size_t i = 0; i < shown.size(); ++i)
                sizes[i] = std::abs(tone.gain[k] * color_of(all[shown[i].point])[k] + tone.offset[k] -
                                    shown[i].color[k]);
            std::vector<double> copy = sizes;
            const double scale = half_weight * std::max(1.4826 * median(copy), least_deviation);
            for (std::size_t i = 0; i < shown.size(); ++i)
                weights[i] = 1 / (1 + sizes[i] * sizes[i] / (scale * scale));
        }
    }
    return tone;
}

std::vector<shown_color> colors_at(const photo_levels& photo, const std::vector<std::uint32_t>& points,
                                   const std::vector<colored_point>& all, const camera& from) {
    const photo_levels::level& largest = photo.all().back();
    const camera c = from.resized(largest.width, largest.height);
    std::vector<shown_color> shown;
    for (const std::uint32_t p : points) {
        const auto place = c.see(all[p].position);
        const auto seen = place ? largest.colors.at(place->x, place->y) : std::nullopt;
        if (seen) shown.push_back({p, seen->color});
    }
    return shown;
}

camera fit_pose(const photo_levels& photo, const std::vector<colored_point>& all,
                const std::vector<std::uint32_t>& points, const camera& start, const camera& given,
                const pose_errors& errors, bool at_all_sizes) {
    camera c = start;
    for (const photo_levels::level& level : photo.all()) {
        if (!at_all_sizes && &level != &photo.all().back()) continue;
        pose_steps fit(level, all, points, c);
        for (int i = 0; i < steps_per_size; ++i) fit.take(given, errors);
        c.rotation = fit.result().rotation;
        c.translation = fit.result().translation;
    }
    return c;
}

}  // namespace gs
