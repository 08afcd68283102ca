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

/// A lens that draws a ray by its angle t from the axis: t (1 + k[0] t^2 + k[1] t^4 + k[2] t^6 + k[3] t^8)
/// focal lengths from the centre (Kannala and Brandt 2006; COLMAP's and OpenCV's fisheye model).
class fisheye {
  public:
    explicit fisheye(const std::array<double, 4>& k);

    const std::array<double, 4>& k() const { return k_; }
    /// How far from the centre a ray of this angle is drawn, in focal lengths.
    double reach(double angle) const;
    /// The angle from which on rays are drawn no farther out, at most `widest`: there the model ends.
    double end() const { return end_; }
    /// The angle that reaches so far; `end()` where none does.
    double angle(double reach) const;

    /// 172 degrees from the axis: near 180 a whole circle is one ray.
    static constexpr double widest = 3;

  private:
    std::array<double, 4> k_;
    double end_;
};

/// A point p of the world is at q = `rotation * p + translation` in camera space (x right, y down, z
/// forward). A pinhole camera has it at (fx x/z + cx, fy y/z + cy) in pixels, where the centre of the top
/// left pixel is (0.5, 0.5).
struct camera {
    int width = 0;
    int height = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    glm::dmat3 rotation{1};
    glm::dvec3 translation{0};
    std::optional<gs::fisheye> fisheye{};  ///< none: a pinhole camera

    glm::dvec3 centre() const { return -glm::transpose(rotation) * translation; }

    struct image_point {
        double x, y;   ///< pixels
        double depth;  ///< z of a pinhole camera, the distance of a fisheye's
    };
    /// Where a point of the world is seen, if it is not behind the camera, or beyond what its lens bends.
    std::optional<image_point> see(const glm::dvec3& point) const;
    /// The direction in the world, of length one, of what is seen at a place of the picture.
    glm::dvec3 ray(double x, double y) const;
};

}  // namespace gs
