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
#include "../poses/pose_change.hpp"
#include "motion_values.hpp"

namespace gs::features {

/// A sink of `raster::project_backward` that sums the gradient with respect to `motion_values`. Leaves out
/// Gaussians whose gradients are not finite.
struct motion_gradient {
    float angle, shift, turn_by_shift;
    train::ordered_sums sums;  ///< `motion_width` sums over all Gaussians

    motion_gradient(const motion_scale& scale, const train::ordered_sums& to)
        : angle(static_cast<float>(scale.angle)),
          shift(static_cast<float>(shift_unit * scale.angle)),
          turn_by_shift(static_cast<float>(1 / scale.depth)),
          sums(to) {}

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return false; }

    template <class W>
    struct row_sink {
        using real = raster::value_t<W, float>;
        using vec3 = raster::vec3<real>;

        const motion_gradient& of;
        const W& w;
        const raster::gaussian_row<W>& row;

        /// Ignores the gradients of the parameters.
        template <int N>
        WARPAGG_HD void operator()(parameter, std::size_t, std::size_t, const glm::vec<N, real>&,
                                   const glm::vec<N, real>&) const {}

        WARPAGG_HD void by_motion(const vec3& at, const vec3& by_velocity, const real& by_readout) const {
            const vec3 by_turn = glm::cross(at, by_velocity);
            const real lever(of.turn_by_shift);
            const vec3 by_shift = by_velocity + vec3(-lever * by_turn.y, lever * by_turn.x, real(0));
            real total[motion_width];
            raster::mask_t<W> sound = row.active && raster::is_finite(by_readout);
            for (int k = 0; k < 3; ++k) {
                total[k] = real(of.angle) * by_turn[k];
                total[3 + k] = real(of.shift) * by_shift[k];
                sound = sound && raster::is_finite(total[k]) && raster::is_finite(total[3 + k]);
            }
            total[6] = real(static_cast<float>(readout_unit)) * by_readout;
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
