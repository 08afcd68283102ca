// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <type_traits>

#include "../geometry/device_camera.hpp"
#include "../geometry/effect_set.hpp"
#include "../geometry/ellipse.hpp"
#include "antialiasing.hpp"

namespace gs::raster {

/// A camera that moves while it takes a photo: see `camera_motion`.
template <class Real>
struct moving_camera : device_camera<Real> {
    vec3<Real> turn, shift;
    Real spread;  ///< standard deviation of the times at which a row is exposed
    Real readout;
    Real rows;  ///< height of the image
};

/// The camera that the projection reads.
template <class Real, effect_set Effects>
using camera_type = std::conditional_t<Effects.motion, moving_camera<Real>, device_camera<Real>>;

/// Convert a camera for the projection.
/// @{
template <class Real>
void set_camera(const camera& from, device_camera<Real>& to) {
    to = for_device<Real>(from);
}
/// Precondition: the camera has a motion.
template <class Real>
void set_camera(const camera& from, moving_camera<Real>& to) {
    const camera_motion& m = *from.motion;
    // The variance of a box of length 1 is 1/12.
    to = {for_device<Real>(from),    vec3<Real>(m.turn),
          vec3<Real>(m.shift),       constant<Real>(std::abs(m.exposure) / std::sqrt(12.0)),
          constant<Real>(m.readout), constant<Real>(from.height)};
}
template <class Real, effect_set Effects>
camera_type<Real, Effects> camera_for(const camera& c) {
    camera_type<Real, Effects> converted{};
    set_camera(c, converted);
    return converted;
}
/// @}

/// The motion of a splat while a photo is taken, to first order: the splat has the velocity v of its
/// center.
///
/// Blur: the splat is the mean over the exposure. To second order, its covariance grows by
/// spread^2 v v^T. Its opacity decreases, so that its total light stays.
///
/// Rolling shutter: the splat is where it is when the row of its center is read. The center y is at
/// y' = y + v.y t with the time t = readout (y' / height - 1/2), which is solved for y'. All pixels of
/// a splat have the same time.
template <class Real>
struct splat_motion {
    vec3<Real> velocity;    ///< in the world
    vec2<Real> v;           ///< in pixels
    vec2<Real> smear;       ///< spread * v
    Real row;               ///< (y' / height - 1/2)
    Real row_per_y;         ///< its derivative
    flag_of<Real> is_free;  ///< whether `row_per_y` depends on v
    vec2<Real> moved;       ///< from the center to its place in the photo

    splat_motion() = default;
    /// `seen`: the projection of the center.
    template <class Projection>
    WARPAGG_HD splat_motion(const Projection& seen, const moving_camera<Real>& camera) {
        velocity = (glm::cross(camera.turn, seen.at) + camera.shift) * camera.rotation;
        v = {glm::dot(seen.px, velocity), glm::dot(seen.py, velocity)};
        smear = camera.spread * v;
        // A splat that is about as fast as the readout would be stretched without bounds.
        const Real rows = camera.rows - camera.readout * v.y, least = camera.rows * constant<Real>(0.25);
        is_free = rows > least;
        row_per_y = 1 / warpagg::math::max(rows, least);
        row = (seen.y - camera.rows * constant<Real>(0.5)) * row_per_y;
        moved = (camera.readout * row) * v;
    }

    /// Returns the shape of a splat with the blur: see `ellipse`.
    WARPAGG_HD ellipse<Real> blurred(const vec3<Real>& ax, const vec3<Real>& ay) const {
        // Two vectors in a plane that have the same Gram matrix. The third component is free.
        const Real size = largest(ax);
        const auto exists = size > Real(0);
        const vec3<Real> scaled = ax / warpagg::math::select(exists, size, Real(1));
        const Real length = warpagg::math::sqrt(glm::dot(scaled, scaled));
        vec3<Real> along = scaled / warpagg::math::select(exists, length, Real(1));
        along.x = warpagg::math::select(exists, along.x, Real(1));
        const Real size_y = warpagg::math::max(largest(ay), constant<Real>(1e-30));
        const vec3<Real> across = glm::cross(along, ay / size_y);
        return {
            vec3<Real>(size * length, Real(0), smear.x),
            vec3<Real>(glm::dot(along, ay), size_y * warpagg::math::sqrt(glm::dot(across, across)), smear.y)};
    }

    /// Returns the opacity factor of the blur: the square root of det(covariance without blur) /
    /// det(covariance). It is 1 with antialiasing, whose factor includes that of the blur. `shape`: with
    /// blur. `ax`, `ay`: see `footprint`.
    template <effect_set Effects>
    WARPAGG_HD Real opacity_left(const ellipse<Real>& shape, const vec3<Real>& ax,
                                 const vec3<Real>& ay) const {
        if constexpr (Effects.antialiasing) return Real(1);
        const whitened_axes<Real> axes(shape, ax, ay);
        return constant<Real>(1.3862943611198906) *
               warpagg::math::sqrt(determinant(shape, ax, ay, glm::cross(axes.x, axes.y)));
    }

    /// Adds the gradient through `opacity_left` to the gradients of the whitened axes. `by_logarithm`:
    /// the gradient with respect to the logarithm of the opacity.
    template <effect_set Effects>
    WARPAGG_HD void add_opacity_left_gradient(const ellipse<Real>& shape, const vec3<Real>& ax,
                                              const vec3<Real>& ay, const whitened_axes<Real>& axes,
                                              const Real& by_logarithm, vec3<Real>& by_x,
                                              vec3<Real>& by_y) const {
        if constexpr (Effects.antialiasing) return;
        const Real p = shape.p, q = shape.q, r = shape.r, two_ln2 = constant<Real>(1.3862943611198906);
        const vec3<Real> area = glm::cross(axes.x, axes.y);
        // The gradient of half the logarithm of the determinant is the inverse of the whitened covariance
        // without blur, times the axes. The terms of axes and filter are apart, so that nothing cancels.
        const Real share = by_logarithm / determinant(shape, ax, ay, area);
        const Real filter = constant<Real>(pixel_variance) * (p * q);
        by_x += share * (glm::cross(axes.y, area) + filter * (q * ax - r * ay)) -
                (by_logarithm * two_ln2) * axes.x;
        by_y += share * (glm::cross(area, axes.x) + (filter * p) * ay) - (by_logarithm * two_ln2) * axes.y;
    }

    /// Returns the gradient of v through the covariance and the opacity. `by_logarithm`: the gradient
    /// with respect to the logarithm of the opacity. `suu`, `suv`, `svv`: the second moments, see `sum`.
    WARPAGG_HD vec2<Real> blur_gradient(const ellipse<Real>& shape, const Real& by_logarithm, const Real& suu,
                                        const Real& suv, const Real& svv) const {
        const Real two_ln2 = constant<Real>(1.3862943611198906), k = two_ln2 * two_ln2;
        // The same as for an axis of the Gaussian: see `project_backward`.
        const Real x = shape.p * smear.x, y = shape.r * smear.x + shape.q * smear.y;
        const Real nx = k * (suu * x + suv * y) - by_logarithm * two_ln2 * x;
        const Real ny = k * (suv * x + svv * y) - by_logarithm * two_ln2 * y;
        return vec2<Real>(shape.p * nx + shape.r * ny, shape.q * ny);
    }

    struct gradients {
        vec2<Real> by_center;    ///< through the row; adds to that of the center
        vec2<Real> by_pixels;    ///< of v
        vec3<Real> by_velocity;  ///< in camera space
        Real by_readout;
    };
    /// `center`: the gradient of the moved center. `by_smear`: see `blur_gradient`.
    template <class Projection>
    WARPAGG_HD gradients gradient(const vec2<Real>& center, const vec2<Real>& by_smear,
                                  const Projection& seen, const moving_camera<Real>& camera) const {
        const Real along = center.x * v.x + center.y * v.y;
        const Real by_row = camera.readout * along;
        const Real change = warpagg::math::select(is_free, by_row * row * row_per_y, Real(0));
        gradients g;
        g.by_center = vec2<Real>(Real(0), by_row * row_per_y);
        g.by_pixels = camera.spread * by_smear + (camera.readout * row) * center;
        g.by_pixels.y += change * camera.readout;
        g.by_velocity = camera.rotation * (g.by_pixels.x * seen.px + g.by_pixels.y * seen.py);
        g.by_readout = along * row + change * v.y;
        return g;
    }

  private:
    /// Returns the determinant of the whitened covariance without blur. `area`: see `opacity_left` of
    /// the antialiasing.
    static WARPAGG_HD Real determinant(const ellipse<Real>& shape, const vec3<Real>& ax, const vec3<Real>& ay,
                                       const vec3<Real>& area) {
        const Real filter = constant<Real>(pixel_variance), pq = shape.p * shape.q;
        const vec3<Real> x = pq * ax, y = pq * ay;
        return glm::dot(area, area) + filter * (glm::dot(x, x) + glm::dot(y, y) + filter * pq * pq);
    }
};

/// Replaces `splat_motion` if the effect is off.
struct no_motion {};
template <class Real, effect_set Effects>
using motion_of_splat = std::conditional_t<Effects.motion, splat_motion<Real>, no_motion>;

}  // namespace gs::raster
