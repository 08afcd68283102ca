// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../geometry/effect_set.hpp"
#include "../geometry/fisheye.hpp"
#include "../geometry/pinhole.hpp"

namespace gs::raster {

/// How a camera of either kind sees a place `at` in camera space:
///     depth(at)            what lies behind what
///     is_drawn(at, camera) not nearer than `near_plane`, and where the camera sees anything at all
///     x, y                 where, in pixels
///     px, py               the rows of the Jacobian of that, by the place in the world
///     inverse_depth_gradient(by_inverse, camera)   by the place in the world, from that by 1 / depth
///     position_gradient(center, dpx, dpy, camera)  by the place in the world, from those by (x, y), px and
///     py
template <class Real, effect_set Effects>
using projection_of = std::conditional_t<Effects.fisheye, fisheye_projection<Real>, pinhole_projection<Real>>;

}  // namespace gs::raster
