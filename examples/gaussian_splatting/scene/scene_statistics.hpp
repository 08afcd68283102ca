// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lens_falloff.hpp"
#include "photo_brightness.hpp"
#include "photo_shifts.hpp"
#include "pose_correction.hpp"
#include "scene.hpp"
#include "tone_response.hpp"

namespace gs {

/// Statistics of a scene's photos that several features share. Each one is computed on first use
/// and kept. Not thread-safe.
class scene_statistics {
  public:
    /// The smallest number of observations of a point that is used.
    static constexpr std::size_t least_photos_of_point = 5;

    explicit scene_statistics(const scene& of) : scene_(of) {}
    /// Uses these observations instead of those in the scene's photos.
    scene_statistics(const scene& of, observed_points points) : scene_(of), points_(std::move(points)) {}

    const gs::scene& scene() const { return scene_; }
    /// Returns the shifts of at most 60 photos: see `measure_shifts`.
    const photo_shifts& shifts() const;
    /// Returns the camera of each training photo: that of the scene, or if photos are clearly shifted, a
    /// corrected one: see `correct_poses`.
    const std::vector<corrected_camera>& cameras() const;
    /// Returns the observations of each point from these cameras: see `observe_points`.
    const observed_points& points() const;
    /// Returns the observations in smooth parts of the photos that are aligned, of points that keep at least
    /// `least_photos_of_point` of them. In rough parts, the color depends too much on the exact
    /// position of the point. The threshold follows the noise, estimated from the smoothest tenth.
    const observed_points& smooth_points() const;
    /// Returns the relative brightness of the photos, measured at the smooth points, and if these are few,
    /// at all points of a similar size. The color of a point in a rough part is uncertain, but the brightness
    /// of a photo is the mean over many points. The lists are empty if there are no points.
    const photo_brightness& brightness() const;
    /// Returns the relative brightness of the photos, measured at the smooth points only.
    const photo_brightness& brightness_of_smooth() const;
    /// Returns the falloff of lenses, measured at the smooth points, and if these are few, at points in
    /// slightly rough parts, too.
    const lens_falloff& falloff() const;
    /// Returns the response of cameras, measured at the smooth points after a clear falloff is removed.
    const tone_response& response() const;
    /// Removes the falloff from the colors of observations if it is clear.
    void remove_clear_falloff(observed_points& points) const;

  private:
    photo_brightness measure_brightness(observed_points points) const;

    const gs::scene& scene_;
    mutable std::optional<photo_shifts> shifts_;
    mutable std::optional<std::vector<corrected_camera>> cameras_;
    mutable std::optional<observed_points> points_, smooth_;
    mutable std::optional<photo_brightness> brightness_, brightness_of_smooth_;
    mutable std::optional<lens_falloff> falloff_;
    mutable std::optional<tone_response> response_;
};

}  // namespace gs
