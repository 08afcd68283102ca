// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "angles.hpp"
#include "device_camera.hpp"
#include "vectors.hpp"

namespace gs::raster {

/// The ratio t / sin t of an angle t with cosine u, and its derivatives with respect to u. It is
/// computed from v = 1 - u as the sum of k! / (2k + 1)!! v^k for k <= 16, which has double
/// precision up to v = 1/4 (41 degrees).
template <class Real>
struct angle_by_sine {
    Real value, first, second;

    WARPAGG_HD explicit angle_by_sine(const Real& v) : value(1), first(0), second(0) {
        WARPAGG_UNROLL
        for (int k = 16; k > 0; --k) {
            const Real ratio = constant<Real>(k / (2.0 * k + 1));
            second = ratio * (v * second + Real(2) * first);
            first = ratio * (v * first + value);
            value = Real(1) + ratio * (v * value);
        }
        first = -first;
    }
};

/// The projection of a point by a fisheye camera: see `projection_of`. A point (x, y, z) in camera
/// space is drawn s (x, y) focal lengths from the center of the image with s = H(u) / |at|. Here, u
/// is the cosine of its angle t from the axis, and H = (1 + k1 t^2 + ...) t / sin t. The lens
/// enters only through H and its derivatives with respect to u, which are smooth on the axis.
template <class Real>
struct fisheye_projection {
    vec3<Real> at, ray;      ///< the point in camera space, and its direction
    Real near;               ///< 1 / |at|
    Real u, h, by_u, by_uu;  ///< the cosine, H, and its derivatives with respect to u
    Real s;
    vec3<Real> ds;  ///< gradient of s with respect to `at`
    Real x, y;
    vec3<Real> px, py;

    static WARPAGG_HD Real depth(const vec3<Real>& at) { return 1 / unit<3, Real>(at).inverse_length; }
    static WARPAGG_HD flag_of<Real> is_drawn(const vec3<Real>& at, const device_camera<Real>& camera) {
        const unit<3, Real> to(at);
        return to.inverse_length < constant<Real>(1 / near_plane) && to.direction.z > camera.least_cosine;
    }

    WARPAGG_HD fisheye_projection(const vec3<Real>& place, const device_camera<Real>& camera) : at(place) {
        const unit<3, Real> to(at);
        ray = to.direction;
        near = to.inverse_length;
        u = ray.z;
        bend(camera);
        s = h * near;
        ds = near * near * (vec3<Real>(Real(0), Real(0), by_u) - (u * by_u + h) * ray);
        x = camera.fx * (s * at.x) + camera.cx;
        y = camera.fy * (s * at.y) + camera.cy;
        px = camera.fx * ((vec3<Real>(s, Real(0), Real(0)) + at.x * ds) * camera.rotation);
        py = camera.fy * ((vec3<Real>(Real(0), s, Real(0)) + at.y * ds) * camera.rotation);
    }

    WARPAGG_HD vec3<Real> position_gradient(const vec2<Real>& center, const vec3<Real>& dpx,
                                            const vec3<Real>& dpy, const device_camera<Real>& camera) const {
        // The gradients with respect to the rows of the Jacobian in camera space, which are
        // s e_x + x ds and s e_y + y ds.
        const vec3<Real> dx = camera.fx * (camera.rotation * dpx), dy = camera.fy * (camera.rotation * dpy);
        const Real cx = camera.fx * center.x, cy = camera.fy * center.y;
        const Real by_s = cx * at.x + cy * at.y + dx.x + dy.y;
        vec3<Real> by_at = by_s * ds + change_of_ds(at.x * dx + at.y * dy);
        by_at.x += cx * s + glm::dot(dx, ds);
        by_at.y += cy * s + glm::dot(dy, ds);
        return by_at * camera.rotation;
    }

    WARPAGG_HD vec3<Real> inverse_depth_gradient(const Real& by_inverse,
                                                 const device_camera<Real>& camera) const {
        return (-by_inverse * near * near * ray) * camera.rotation;
    }

  private:
    /// Computes H and its derivatives with respect to u.
    WARPAGG_HD void bend(const device_camera<Real>& camera) {
        using warpagg::math::sqrt;
        const Real one(1), half = constant<Real>(0.5);
        const Real q = ray.x * ray.x + ray.y * ray.y;  // the square of the sine
        const vec4<Real>& k = camera.bends;
        // v = 1 - cos t, without cancellation for small t. `halved` maps it to 1 - cos(t / 2). The
        // angle is computed from a quarter of it, for which the series converges fast.
        const Real v = select(u > Real(0), q / (one + u), one - u);
        const auto halved = [&](const Real& vers) { return half * vers / (one + sqrt(one - half * vers)); };
        const Real quarter = halved(halved(v));
        const Real angle = Real(4) * angle_by_sine<Real>(quarter).value * sqrt(quarter * (Real(2) - quarter));
        const angle_by_sine<Real> near_axis(warpagg::math::min(v, constant<Real>(0.25)));
        const auto is_near = v < constant<Real>(0.25);
        const Real square = select(is_near, one, q);
        const Real e = select(is_near, near_axis.value, angle / sqrt(square));
        const Real e1 = select(is_near, near_axis.first, (u * e - one) / square);
        const Real e2 = select(is_near, near_axis.second, (Real(3) * u * e1 + e) / square);

        // w = t^2 and its derivatives with respect to u.
        const Real w = angle * angle, w1 = Real(-2) * e, w2 = Real(-2) * e1;
        const Real p = one + w * (k.x + w * (k.y + w * (k.z + w * k.w)));
        const Real by_w = k.x + w * (Real(2) * k.y + w * (Real(3) * k.z + w * (Real(4) * k.w)));
        const Real by_ww = Real(2) * k.y + w * (Real(6) * k.z + w * (Real(12) * k.w));
        const Real p1 = by_w * w1, p2 = by_ww * w1 * w1 + by_w * w2;
        h = p * e;
        by_u = p1 * e + p * e1;
        by_uu = p2 * e + Real(2) * p1 * e1 + p * e2;
    }

    /// Returns the change of `ds` along `step`: the Hessian of s times `step`.
    WARPAGG_HD vec3<Real> change_of_ds(const vec3<Real>& step) const {
        const Real farther = glm::dot(ray, step);
        const Real du = near * (step.z - u * farther);
        const vec3<Real> turned = near * (step - farther * ray);
        const vec3<Real> change = vec3<Real>(Real(0), Real(0), by_uu * du) -
                                  (du * (u * by_uu + Real(2) * by_u)) * ray - (u * by_u + h) * turned;
        return near * near * change - Real(2) * near * farther * ds;
    }
};

/// Returns the unit direction in camera space of the ray through a place in the image, which is
/// given in focal lengths from the center. Beyond the end of the lens model, returns a ray at its
/// largest angle.
template <class Real>
WARPAGG_HD vec3<Real> fisheye_ray(const vec2<Real>& place, const device_camera<Real>& camera) {
    using warpagg::math::max;
    using warpagg::math::min;
    const Real out = warpagg::math::sqrt(glm::dot(place, place)), one(1);
    const vec4<Real>& k = camera.bends;
    Real angle = min(out, camera.end);
    for (int step = 0; step < 8; ++step) {  // Newton's method
        const Real w = angle * angle;
        const Real radius = angle * (one + w * (k.x + w * (k.y + w * (k.z + w * k.w))));
        const Real slope =
            one + w * (Real(3) * k.x + w * (Real(5) * k.y + w * (Real(7) * k.z + w * (Real(9) * k.w))));
        angle = min(max(angle + (out - radius) / max(slope, constant<Real>(1e-3)), Real(0)), camera.end);
    }
    const sine_and_cosine<Real> direction(angle);
    const Real share = select(out > Real(0), direction.sine / max(out, constant<Real>(1e-30)), one);
    return {share * place.x, share * place.y, direction.cosine};
}

}  // namespace gs::raster
