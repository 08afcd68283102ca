// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <warpagg/atomic.hpp>

#include "../../model/parameters.hpp"
#include "../../optimize/ordered_sums.hpp"
#include "../../render/geometry/vectors.hpp"
#include "../../render/project/gaussian_row.hpp"
#include "pose_change.hpp"

namespace gs::features {

/// A sink of `raster::project_backward` that sums the gradient with respect to a pose change. To turn
/// or shift the camera has the effect of the opposite motion of all Gaussians, except that colors
/// depend on the position of the camera and not on its rotation. A learned sky has no part in it. Leaves out
/// Gaussians whose gradients are not finite.
struct pose_gradient {
    raster::mat3<float> by_turn, by_shift, turning, by_lever;  ///< see `pose_derivatives`
    train::ordered_sums sums;                                  ///< `pose_width` sums over all Gaussians

    pose_gradient(const pose_derivatives& d, const train::ordered_sums& to)
        : by_turn(d.by_turn), by_shift(d.by_shift), turning(d.turning), by_lever(d.by_lever), sums(to) {}

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return false; }

    template <class W>
    struct row_sink {
        using real = raster::value_t<W, float>;
        using vec3 = raster::vec3<real>;

        const pose_gradient& of;
        const W& w;
        const raster::gaussian_row<W>& row;

        /// Ignores the gradients of the parameters.
        template <int N>
        WARPAGG_HD void operator()(parameter, std::size_t, std::size_t, const glm::vec<N, real>&,
                                   const glm::vec<N, real>&) const {}

        WARPAGG_HD void by_camera(const vec3& offset, const vec3& by_position, const vec3& by_mean,
                                  const raster::vec4<real>& q, const raster::vec4<real>& by_q) const {
            // A rotation by a small vector v changes the quaternion q by (0, v) q / 2.
            const vec3 axis(q.y, q.z, q.w), by_axis(by_q.y, by_q.z, by_q.w);
            const vec3 orientation = real(0.5f) * (q.x * by_axis - by_q.x * axis + glm::cross(axis, by_axis));
            // The center of the camera moves by the opposite of the mean's motion.
            const vec3 turn =
                raster::mat3<real>(of.by_turn) * (glm::cross(offset, by_position) + orientation) -
                raster::mat3<real>(of.by_lever) * by_mean;
            const vec3 shift =
                raster::mat3<real>(of.turning) * turn - raster::mat3<real>(of.by_shift) * by_mean;
            real total[pose_width];
            raster::mask_t<W> sound = row.active;
            for (int k = 0; k < 3; ++k) {
                total[k] = turn[k];
                total[3 + k] = shift[k];
                sound = sound && raster::is_finite(turn[k]) && raster::is_finite(shift[k]);
            }
            const std::size_t warp = row.first / W::size;
            const auto part = [&](unsigned k) { return of.sums(k, warp); };
            warpagg::warp_reduce_atomic(w, part, total, sound);
        }
    };
    template <class W>
    WARPAGG_HD row_sink<W> for_row(const W& w, const raster::gaussian_row<W>& row) const {
        return {*this, w, row};
    }
};

}  // namespace gs::features
