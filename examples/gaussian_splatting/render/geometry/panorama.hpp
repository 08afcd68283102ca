// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "angles.hpp"
#include "device_camera.hpp"
#include "vectors.hpp"

namespace gs::raster {

/// The projection of a point in a panorama: see `projection_of`. The directions in which longitude,
/// latitude and distance grow are at right angles. The derivatives are simple in these coordinates.
///
/// At the poles, the longitude is undefined and its derivative is infinite. Points there are drawn
/// as if they were next to the pole at longitude zero. Their splats are wider than the image, so
/// that the longitude hardly matters.
template <class Real>
struct panorama_projection {
    Real near, flat;              ///< 1 / distance from the camera, and from its vertical axis
    vec3<Real> ray, east, south;  ///< directions in which distance, longitude and latitude grow
    vec3<Real> outward;           ///< horizontal direction away from the axis
    Real tangent;                 ///< of the latitude
    Real x, y;
    vec3<Real> px, py;

    static WARPAGG_HD Real depth(const vec3<Real>& at) { return 1 / unit<3, Real>(at).inverse_length; }
    static WARPAGG_HD flag_of<Real> is_drawn(const vec3<Real>& at, const device_camera<Real>&) {
        return unit<3, Real>(at).inverse_length < constant<Real>(1 / near_plane);
    }

    WARPAGG_HD panorama_projection(const vec3<Real>& at, const device_camera<Real>& camera) {
        const unit<3, Real> to(at);
        ray = to.direction;
        near = to.inverse_length;
        const Real zero(0), least = constant<Real>(least_cosine);
        const Real across = warpagg::math::sqrt(ray.x * ray.x + ray.z * ray.z);
        const auto is_pole = !(across > least);
        const Real cosine = select(is_pole, least, across);
        outward = {select(is_pole, zero, ray.x / cosine), zero, select(is_pole, Real(1), ray.z / cosine)};
        east = {outward.z, zero, -outward.x};
        south = {-ray.y * outward.x, cosine, -ray.y * outward.z};
        flat = near / cosine;
        tangent = ray.y / cosine;
        x = camera.fx * angle_of(outward.x, outward.z) + camera.cx;
        y = camera.fy * angle_of(ray.y, cosine) + camera.cy;
        px = (camera.fx * flat) * (east * camera.rotation);
        py = (camera.fy * near) * (south * camera.rotation);
    }

    WARPAGG_HD vec3<Real> position_gradient(const vec2<Real>& center, const vec3<Real>& dpx,
                                            const vec3<Real>& dpy, const device_camera<Real>& camera) const {
        // The gradients with respect to the derivatives of longitude and latitude in camera space.
        // The change of these derivatives along a step is the Hessian times the step.
        const vec3<Real> dx = camera.fx * (camera.rotation * dpx), dy = camera.fy * (camera.rotation * dpy);
        const vec3<Real> by_longitude =
            (-flat * flat) * (glm::dot(outward, dx) * east + glm::dot(east, dx) * outward);
        const vec3<Real> by_latitude =
            (-near * near) *
            (glm::dot(ray, dy) * south + glm::dot(south, dy) * ray + (tangent * glm::dot(east, dy)) * east);
        return ((camera.fx * center.x * flat) * east + (camera.fy * center.y * near) * south + by_longitude +
                by_latitude) *
               camera.rotation;
    }

    WARPAGG_HD vec3<Real> inverse_depth_gradient(const Real& by_inverse,
                                                 const device_camera<Real>& camera) const {
        return (-by_inverse * near * near * ray) * camera.rotation;
    }

  private:
    /// The cosine of the latitude at which a pole begins.
    static constexpr double least_cosine = 1e-6;
};

/// Returns the unit direction in camera space at a longitude and a latitude.
template <class Real>
WARPAGG_HD vec3<Real> panorama_ray(const vec2<Real>& place) {
    const sine_and_cosine<Real> longitude(place.x), latitude(place.y);
    return {latitude.cosine * longitude.sine, latitude.sine, latitude.cosine * longitude.cosine};
}

/// Returns the difference of two longitudes in pixels, `offset`, as the nearest one of the same
/// direction. Precondition: it is between -1.5 and 1.5 times the width of the panorama.
template <class Real>
WARPAGG_HD Real nearest_offset(const Real& offset, const Real& width) {
    const Real half = constant<Real>(0.5) * width, zero(0);
    // mutate: seam_not_wrapped
    return offset - select(offset > half, width, select(offset < -half, -width, zero));
}

}  // namespace gs::raster
