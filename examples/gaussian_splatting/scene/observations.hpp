// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "scene.hpp"

namespace gs {

/// The appearance of one scene point in one photo.
struct observation {
    std::uint32_t view = 0;
    glm::vec3 color{0};       ///< mean of the 3×3 pixels around it, as displayed, in [0, 1]
    glm::dvec2 place{0};      ///< in the photo, in pixels: see `camera::image_point`
    glm::vec3 direction{0};   ///< from the camera to the point, of length one
    float footprint = 0;      ///< width of a pixel at the point's depth, in units of the scene
    float roughness = 0;      ///< (brightest - darkest) / brightest of these pixels
    std::uint32_t point = 0;  ///< index in `scene::points`
};

/// The observations of each point.
using observed_points = std::vector<std::vector<observation>>;

/// Keeps the largest set of observations of a point in which the footprints differ by at most this
/// factor. From a larger distance, the color of a point mixes with its surroundings.
void keep_one_size(std::vector<observation>& seen, float factor);

/// The pixel coordinates and the depth of a point in a photo: see `camera::image_point`.
struct place_in_photo {
    std::uint32_t point;
    double x, y, depth;
};

/// Projects the points that a camera sees. Leaves out a point if a clearly nearer one may hide it,
/// up to a few point spacings away in the image.
std::vector<place_in_photo> points_in_sight(const camera& camera, const std::vector<colored_point>& points);

/// Collects the observations of a sample of the points, at most 6000, in the training photos. Skips
/// observations of points that are not `points_in_sight`, and those where the photo is transparent
/// or a color channel is saturated. Cost: projects all points into all photos.
class point_observer {
  public:
    /// The scene must outlive the object.
    explicit point_observer(const scene& of);
    /// Observes the points in the photo of a training view. `taken_with`: the camera with its exact pose.
    /// Several threads may call this and the next function, for different views.
    void observe(std::size_t view, const image& photo, const camera& taken_with);
    /// Observes these points `in_sight` in patches that replace the photo around them. The image is three
    /// pixels wide and has the 3×3 pixels of each point, one point below the other.
    void observe_patches(std::size_t view, std::span<const place_in_photo> points, const image& patches,
                         const camera& taken_with);
    /// Returns the points of the sample that are `points_in_sight`.
    std::vector<place_in_photo> in_sight(const camera& camera) const;
    observed_points observations() const;

  private:
    void keep(std::size_t view, const place_in_photo& p, observation o, const camera& taken_with);

    const scene& scene_;
    std::size_t step_;  ///< distance of two points of the sample
    std::vector<std::vector<std::pair<std::uint32_t, observation>>> by_view_;
};

/// Returns the observations in all training photos: see `point_observer`. `cameras`: of each photo.
observed_points observe_points(const scene& of, std::span<const camera> cameras);
/// Uses the cameras of the scene.
observed_points observe_points(const scene& of);

}  // namespace gs
