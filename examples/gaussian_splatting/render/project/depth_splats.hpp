// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../model/aosoa.hpp"
#include "../geometry/splat.hpp"
#include "geometry.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// Makes splats that render inverse depths: red is the inverse depth of the Gaussian, and green and
/// blue are zero. One index per Gaussian.
template <class Real, effect_set Effects>
struct depth_splats {
    const Real* mean;  ///< means of all Gaussians, see `parameter_arrays`
    device_camera<Real> camera;
    const splat<Real>* splats;
    splat<Real>* shown;

    WARPAGG_HD void operator()(std::size_t i) const {
        vec3<Real> at;
        for (unsigned k = 0; k < 3; ++k) at[static_cast<int>(k)] = mean[aosoa_index(i, k, 3)];
        splat<Real> s = splats[i];
        s.red = 1 / projection_of<Real, Effects>::depth(in_camera(at, camera));
        s.green = s.blue = 0;
        shown[i] = s;
    }
};

/// Moves the gradient sum of red to the sum of inverse depths, and clears it for the backward pass
/// of the colors. One index per Gaussian.
template <class Sum>
struct set_red_aside {
    Sum* sums;

    WARPAGG_HD void operator()(std::size_t i) const {
        Sum* record = sums + i * record_stride;
        record[sum_inverse_depth] = record[sum_red];
        record[sum_red] = Sum{};
    }
};

}  // namespace gs::raster
