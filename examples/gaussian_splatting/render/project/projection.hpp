// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../geometry/effect_set.hpp"
#include "../geometry/fisheye.hpp"
#include "../geometry/panorama.hpp"
#include "../geometry/pinhole.hpp"

namespace gs::raster {

/// The projection of a point by a fisheye camera or in a panorama: see `projection_of`.
template <class Real, effect_set Effects>
using wide_projection_of = std::conditional_t<Effects.lens == lens_model::fisheye, fisheye_projection<Real>,
                                              panorama_projection<Real>>;

/// The projection of a point `at` in camera space. Its members are:
/// - `depth(at)`: the depth, by which splats are sorted.
/// - `is_drawn(at, camera)`: whether the depth exceeds `near_plane` and the camera can see it.
/// - `x`, `y`: the position in the image in pixels.
/// - `px`, `py`: the rows of the Jacobian of (x, y) with respect to the point in the world.
/// - `position_gradient(center, dpx, dpy, camera)`: the gradient with respect to the point in the
///   world. `center`, `dpx` and `dpy` are the gradients with respect to (x, y), `px` and `py`.
/// - `inverse_depth_gradient(by_inverse, camera)`: the same, from the gradient with respect to
///   1 / depth.
template <class Real, effect_set Effects>
using projection_of = std::conditional_t<Effects.lens != lens_model::pinhole,
                                         wide_projection_of<Real, Effects>, pinhole_projection<Real>>;

}  // namespace gs::raster
