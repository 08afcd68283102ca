// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "camera.hpp"
#include "scene.hpp"
#include "smooth_colors.hpp"

namespace gs {

/// A photo at several sizes, each half as large as the one before. Larger sizes come later.
class photo_levels {
  public:
    /// The photo is at the largest size.
    explicit photo_levels(image photo);

    struct level {
        int width, height;
        smooth_colors colors;
    };
    const std::vector<level>& all() const { return levels_; }

  private:
    std::vector<level> levels_;
};

/// The typical errors of a given pose: standard deviations of each of three numbers.
struct pose_errors {
    double turn;   ///< radians
    double shift;  ///< units of the scene
};

/// How a photo shows the colors of points: gain * color + offset, for each channel.
struct photo_tone {
    glm::dvec3 gain{1}, offset{0};
};

/// The color that a photo shows at the place of a point, in [0, 1].
struct shown_color {
    std::uint32_t point;
    glm::dvec3 color;
};

/// Changes the pose of a camera so that its photo shows the colors of these points at their places. Minimizes
/// the robust sum of squares of color differences, divided by their variance, plus that of the pose change
/// relative to `given`, divided by the variance of `errors`. So a change that the photo does not determine
/// stays small. Uses Gauss-Newton steps from the smallest size of the photo to the largest one (Lucas and
/// Kanade 1981; photometric bundle adjustment: Engel et al. 2018), or at the largest one only. Solves for a
/// `photo_tone`, too. `points`: indices in `all`. Cost: 20 projections of each point.
camera fit_pose(const photo_levels& photo, const std::vector<colored_point>& all,
                const std::vector<std::uint32_t>& points, const camera& start, const camera& given,
                const pose_errors& errors, bool at_all_sizes);

/// Returns the colors at the places of points that the largest size of the photo shows.
std::vector<shown_color> colors_at(const photo_levels& photo, const std::vector<std::uint32_t>& points,
                                   const std::vector<colored_point>& all, const camera& from);

/// Returns the tone that fits best, by iteratively reweighted least squares. Gains are from 0.1 to 10.
photo_tone fit_tone(const std::vector<shown_color>& shown, const std::vector<colored_point>& all);

/// Returns a camera after a motion in camera space: a rotation vector about the center of the camera, and
/// then a shift of the scene.
camera moved_in_camera_space(camera c, const glm::dvec3& turn, const glm::dvec3& shift);

/// Returns the camera that turns so that points move by about this number of pixels in its image.
camera turned_to(const camera& c, const std::vector<colored_point>& points, const glm::dvec2& pixels);

}  // namespace gs
