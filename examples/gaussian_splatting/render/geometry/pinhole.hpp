// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "device_camera.hpp"
#include "vectors.hpp"

namespace gs::raster {

using warpagg::math::select;

/// The projection of a point by a pinhole camera: see `projection_of`.
template <class Real>
struct pinhole_projection {
    vec3<Real> at;                 ///< the point in camera space
    Real u, v;                     ///< x/z and y/z, clamped for the Jacobian
    flag_of<Real> u_free, v_free;  ///< whether u and v are not clamped
    Real x, y;
    vec3<Real> px, py;

    static WARPAGG_HD Real depth(const vec3<Real>& at) { return at.z; }
    static WARPAGG_HD flag_of<Real> is_drawn(const vec3<Real>& at, const device_camera<Real>&) {
        return at.z > constant<Real>(near_plane);
    }

    WARPAGG_HD pinhole_projection(const vec3<Real>& place, const device_camera<Real>& camera) : at(place) {
        using warpagg::math::max;
        using warpagg::math::min;
        const Real rz = 1 / at.z;
        const Real x_by_z = at.x / at.z, y_by_z = at.y / at.z;  // valid even if 1 / z underflows
        u = min(max(x_by_z, camera.least_x), camera.most_x);
        v = min(max(y_by_z, camera.least_y), camera.most_y);
        u_free = u == x_by_z;
        v_free = v == y_by_z;
        x = camera.fx * x_by_z + camera.cx;
        y = camera.fy * y_by_z + camera.cy;
        px = camera.fx * rz * (camera.axis(0) - u * camera.axis(2));
        py = camera.fy * rz * (camera.axis(1) - v * camera.axis(2));
    }

    WARPAGG_HD vec3<Real> position_gradient(const vec2<Real>& center, const vec3<Real>& dpx,
                                            const vec3<Real>& dpy, const device_camera<Real>& camera) const {
        const Real rz = 1 / at.z;
        // px = fx / z (row 0 - u row 2) with the rows of the rotation, and u = x / z unless
        // clamped.
        // mutate: clamped_jacobian_as_if_free
        const Real du = select(u_free, -camera.fx * rz * glm::dot(dpx, camera.axis(2)), Real(0));
        const Real dv = select(v_free, -camera.fy * rz * glm::dot(dpy, camera.axis(2)), Real(0));
        vec3<Real> by_at(camera.fx * rz * center.x, camera.fy * rz * center.y, Real(0));
        by_at.z = -rz * (by_at.x * at.x + by_at.y * at.y) - rz * (glm::dot(dpx, px) + glm::dot(dpy, py)) -
                  rz * (du * u + dv * v);
        by_at.x += du * rz;
        by_at.y += dv * rz;
        return by_at * camera.rotation;
    }

    WARPAGG_HD vec3<Real> inverse_depth_gradient(const Real& by_inverse,
                                                 const device_camera<Real>& camera) const {
        const Real rz = 1 / at.z;
        return vec3<Real>(Real(0), Real(0), -by_inverse * rz * rz) * camera.rotation;
    }
};

}  // namespace gs::raster
