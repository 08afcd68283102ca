// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace gs {

/// A fisheye lens (Kannala and Brandt 2006; the model of COLMAP and OpenCV). It projects a ray at
/// the angle t from the axis to the distance t (1 + k[0] t^2 + k[1] t^4 + k[2] t^6 + k[3] t^8) from
/// the center, in focal lengths. Angles are in radians.
class fisheye {
  public:
    explicit fisheye(const std::array<double, 4>& k);

    const std::array<double, 4>& k() const { return k_; }
    /// Returns the distance from the center, in focal lengths, of a ray at this angle.
    double radius(double angle) const;
    /// Returns the angle at which `radius` stops growing, where the model ends. It is at most
    /// `widest`.
    double end() const { return end_; }
    /// Returns the angle of a ray at this distance, the inverse of `radius`. Distances beyond the
    /// range of `radius` give `end()`.
    double angle(double radius) const;

    /// The largest angle of a ray, 172 degrees. Near 180 degrees, a whole circle of pixels would
    /// show the same point.
    static constexpr double widest = 3;

  private:
    std::array<double, 4> k_;
    double end_;
};

/// The motion of the scene in camera space while a photo is taken. A point q has the velocity
/// cross(turn, q) + shift per unit of time. The pose of the camera belongs to the middle of the
/// exposure of the middle row.
struct camera_motion {
    glm::dvec3 turn{0};   ///< in radians
    glm::dvec3 shift{0};  ///< in the unit of the scene
    double exposure = 1;  ///< the time for which each row is exposed
    double readout = 0;   ///< the time from the first row to the last row; negative if the last is first
};

/// How a camera maps directions to its image: see `camera`.
enum class lens_model { pinhole, fisheye, panorama };

/// A camera. It maps a world point p to q = `rotation * p + translation` in camera space (x right,
/// y down, z forward). A pinhole camera projects q to the pixel coordinates (fx q.x/q.z + cx, fy
/// q.y/q.z + cy). The center of the top left pixel is (0.5, 0.5).
///
/// A panorama is an equirectangular image of all directions. It shows q at the pixel coordinates
/// (fx a + cx, fy b + cy). The longitude a = atan2(q.x, q.z) is zero forward, and the latitude
/// b = atan2(q.y, hypot(q.x, q.z)) is positive downward. The left and the right border of the image
/// are the same meridian, so x is periodic.
struct camera {
    int width = 0;
    int height = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    glm::dmat3 rotation{1};
    glm::dvec3 translation{0};
    std::optional<gs::fisheye> fisheye{};  ///< the lens of a fisheye camera
    bool is_panorama = false;              ///< if true, `fisheye` is empty
    /// The motion that renders simulate, except those of panoramas.
    std::optional<camera_motion> motion{};

    /// Returns the camera of a panorama of this size at the origin.
    static camera panorama(int width, int height);

    lens_model lens() const {
        if (is_panorama) return lens_model::panorama;
        return fisheye ? lens_model::fisheye : lens_model::pinhole;
    }
    glm::dvec3 center() const { return -glm::transpose(rotation) * translation; }

    struct image_point {
        double x, y;   ///< pixels
        double depth;  ///< z for a pinhole camera, otherwise the distance from the camera
    };
    /// Projects a world point. Returns nothing if the point is behind a pinhole camera, beyond the
    /// end of a fisheye lens, or at the center of another lens.
    std::optional<image_point> see(const glm::dvec3& point) const;
    /// Returns the unit vector in world space that projects to these pixel coordinates.
    glm::dvec3 ray(double x, double y) const;

    /// Returns the camera of the same image after it is scaled to another size.
    camera resized(int new_width, int new_height) const;
};

}  // namespace gs
