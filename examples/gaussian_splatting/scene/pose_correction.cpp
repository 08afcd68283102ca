// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "pose_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>

#include "../core/median.hpp"
#include "../core/parallel.hpp"
#include "observations.hpp"
#include "pose_fit.hpp"
#include "view_photo.hpp"

namespace gs {
namespace {

constexpr int correction_rounds = 8;
constexpr std::size_t most_tracked = 6000, most_fitted = 1000;
constexpr int largest_side = 400;                 ///< of a compared photo, in pixels
constexpr std::size_t least_aligned_points = 20;  ///< that a photo shows if it is aligned
constexpr std::size_t least_coloring_photos = 3;  ///< that determine the color of a point
constexpr double largest_difference = 3;          ///< from the colors of points, relative to the median photo

image reduced(const image& photo) {
    const int side = std::max(photo.width, photo.height), divisor = (side + largest_side - 1) / largest_side;
    if (divisor <= 1) return photo;
    return downsample(photo, std::max(1, photo.width / divisor), std::max(1, photo.height / divisor));
}

/// Returns every nth value so that at most this number remains.
std::vector<std::uint32_t> sample(const std::vector<std::uint32_t>& all, std::size_t most) {
    const std::size_t step = std::max<std::size_t>((all.size() + most - 1) / most, 1);
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
}

/// A photo whose pose is corrected.
struct aligned_photo {
    image pixels;  ///< reduced
    camera start, pose;
    std::vector<std::uint32_t> points;  ///< in sight
    std::vector<shown_color> shown{};
    photo_tone tone{};
    double difference = 0;  ///< the median difference from the colors of points
    bool is_aligned = false;
    bool is_new = true;  ///< whether its pose starts far from the solution
};

class correction {
  public:
    correction(const scene& of, const photo_shifts& shifts)
        : scene_(of),
          photos_(of.train.size()),
          points_(of.points),
          is_known_(of.points.size()),
          step_(of.points.size() / most_tracked + 1) {
        for (std::size_t p = 0; p < is_known_.size(); p += step_) is_known_[p] = true;
        const double angle =
            std::max(shifts.median_shift(), photo_shifts::least_shift) / of.train.front().camera.fx;
        errors_ = {angle, angle * of.extent()};
        for_each_in_parallel(photos_.size(), [&](std::size_t v) {
            photos_[v].pixels = reduced(view_photo(of.train[v]).pixels());
            start(v, shifts.photos[v]);
        });
    }

    /// Fits the poses to the colors of points. `searches`: whether photos that are not aligned start again
    /// from their shifts against these colors.
    void improve(bool searches) {
        std::vector<colored_point> known;
        for (std::size_t p = 0; p < points_.size(); ++p)
            if (is_known_[p]) known.push_back(points_[p]);
        for_each_in_parallel(photos_.size(), [&](std::size_t v) {
            aligned_photo& photo = photos_[v];
            if (searches && !photo.is_aligned)
                start(v, measure_shift(known, scene_.train[v].camera, view_photo(scene_.train[v]).pixels()));
            std::vector<std::uint32_t> points = photo.points;
            std::erase_if(points, [&](std::uint32_t p) { return !is_known_[p]; });
            const photo_levels levels(photo.pixels);
            photo.pose = fit_pose(levels, points_, sample(points, most_fitted), photo.pose,
                                  scene_.train[v].camera, errors_, photo.is_new);
            photo.is_new = false;
            photo.shown = colors_at(levels, photo.points, points_, photo.pose);
            compare(photo);
        });
        judge();
    }

    /// Makes the color of each point its median over photos that are aligned.
    void recolor() {
        std::vector<std::array<std::vector<double>, 3>> colors(points_.size());
        for (const aligned_photo& photo : photos_) {
            if (!photo.is_aligned) continue;
            for (const auto& [point, color] : photo.shown) {
                const glm::dvec3 evened = (color - photo.tone.offset) / photo.tone.gain;
                for (int k = 0; k < 3; ++k) colors[point][static_cast<std::size_t>(k)].push_back(evened[k]);
            }
        }
        for (std::size_t p = 0; p < points_.size(); ++p) {
            is_known_[p] = colors[p][0].size() >= least_coloring_photos;
            if (is_known_[p])
                for (int k = 0; k < 3; ++k)
                    points_[p].color[k] = static_cast<std::uint8_t>(
                        std::clamp(255 * median(colors[p][static_cast<std::size_t>(k)]) + 0.5, 0.0, 255.0));
        }
    }

    std::vector<corrected_camera> cameras() const {
        std::vector<corrected_camera> found;
        for (const aligned_photo& photo : photos_)
            found.push_back({photo.is_aligned ? photo.pose : photo.start, photo.is_aligned});
        return found;
    }

  private:
    /// Starts from a turn of the given pose that removes the shift.
    void start(std::size_t v, const photo_shift& shift) {
        aligned_photo& photo = photos_[v];
        photo.start = scene_.train[v].camera;
        if (shift.is_judged) photo.start = turned_to(photo.start, scene_.points, shift.pixels);
        photo.pose = photo.start;
        photo.points.clear();
        for (const place_in_photo& p : points_in_sight(photo.pose, scene_.points))
            if (p.point % step_ == 0) photo.points.push_back(p.point);
        photo.is_new = true;
    }

    void compare(aligned_photo& photo) const {
        std::vector<shown_color> known = photo.shown;
        std::erase_if(known, [&](const shown_color& s) { return !is_known_[s.point]; });
        photo.is_aligned = known.size() >= least_aligned_points;
        photo.tone = fit_tone(known, points_);
        std::vector<double> differences;
        for (const auto& [point, color] : known)
            differences.push_back(glm::length((color - photo.tone.offset) / photo.tone.gain -
                                              glm::dvec3(points_[point].color) / 255.0));
        photo.difference = median(differences);
    }

    /// Photos are not aligned if they differ from the points much more than the median photo.
    void judge() {
        std::vector<double> differences;
        for (const aligned_photo& photo : photos_)
            if (photo.is_aligned) differences.push_back(photo.difference);
        const double limit = largest_difference * median(differences);
        for (aligned_photo& photo : photos_) photo.is_aligned = photo.is_aligned && photo.difference <= limit;
    }

    const scene& scene_;
    std::vector<aligned_photo> photos_;
    std::vector<colored_point> points_;  ///< with the colors of photos
    std::vector<char> is_known_;         ///< of each point, whether its color is compared
    std::size_t step_;                   ///< distance of two points of the sample
    pose_errors errors_{};
};

}  // namespace

std::vector<corrected_camera> correct_poses(const scene& of, const photo_shifts& shifts) {
    correction all(of, shifts);
    for (int round = 0; round < correction_rounds; ++round) {
        if (round > 0) all.recolor();
        all.improve(round > 0);
    }
    return all.cameras();
}

}  // namespace gs
