// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../reader.hpp"

namespace gs {

/// Reads the raw data that the app Polycam exports: a folder `keyframes` with one JSON file per
/// camera, photos, and possibly depth maps of a LiDAR sensor. Prefers the corrected cameras and
/// photos. Leaves out blurry photos. The points come from the depth maps. The world has z up, as
/// nerfstudio has it.
extern const reader polycam_reader;

}  // namespace gs
