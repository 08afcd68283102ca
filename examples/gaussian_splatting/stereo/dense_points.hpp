// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../scene/scene.hpp"

namespace gs::stereo {

/// Returns points on the surfaces that the training photos show, with their colors: those that the sweeps
/// (see `sweep`) of at least two photos agree on. Each photo is compared with up to four others that look
/// at the same place from other directions. The points of the scene tell the range of distances; without
/// them, it is wide. Returns few points, or none, where photos are smooth, far apart or have wrong poses.
///
/// Precondition: the scene is normalized. Cost: up to 400 photos, evenly from all, are decoded. Each takes
/// a fraction of a second of one thread.
std::vector<colored_point> dense_points(const scene& of);

}  // namespace gs::stereo
