// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../../scene/scene.hpp"

namespace gs {

/// A ray-traced scene that needs no download, with exact cameras around its upper half (z is up), on a
/// hemisphere unless parameters say otherwise. Everything lies within 1.3 of the origin along each axis.
/// `name` is that of a world and, behind commas, parameters: see `synthetic_parameters`; without any, shading
/// does not depend on the direction one looks from.
///
///     spheres   patterned spheres in a pool of light on a dark ground; opaque, black where nothing is
///     alpha     spheres that float before a transparent background
///
/// 40 views train and 8 test, all 48 train without `options.eval`; 128 pixels square before
/// `options.resolution`. `points` are about 3000 surface points, each seen by a training camera, drawn by
/// `options.seed`. The result does not depend on the number of threads. Throws `error` for an unknown name or
/// parameter.
scene make_synthetic_scene(const std::string& name, const load_options& options, const log_function& log);

/// Takes the photos that the views' cameras have of the same world: other cameras than the scene's own, in no
/// sphere.
void photograph_synthetic(const std::string& name, std::vector<view>& views);

/// More of its surface points. Precondition: some view sees a surface.
std::vector<coloured_point> synthetic_points(const std::string& name, const std::vector<view>& views,
                                             std::size_t count, std::uint64_t seed);

}  // namespace gs
