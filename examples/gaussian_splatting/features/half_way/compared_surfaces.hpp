// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "../feature.hpp"

namespace gs::features {

/// How photos differ from the renders of a model, in cells: see `compare_with_photos`.
struct compared_surfaces {
    observed_points smooth;  ///< cells of space, from smooth parts of surfaces
    observed_points all;     ///< cells of space, from all parts of surfaces
    observed_points sky;     ///< cells of directions in which there is nothing near
};

/// Compares training photos with renders of the model. An observation is the mean over a cell in a photo: the
/// color of the photo relative to that of the render, times the typical render of the cell. So neither the
/// distance of a camera nor the texture of a surface matters. All footprints are one.
///
/// Leaves out pixels that are saturated, masked, transparent or dark, and edges of surfaces. `smooth` and
/// `sky` leave out the roughest part of the photos, too. `show` applies effects to renders. Examines up to
/// 120 photos. Precondition: `prepare_renders` was called. Cost: renders each of these photos twice.
compared_surfaces compare_with_photos(train::engine& engine, const scene& scene, const show_function& show,
                                      const std::array<float, 3>& background);

}  // namespace gs::features
