// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "settings.hpp"

namespace gs::cli {

/// Returns the options that read the scene of `train`. With --poses auto, first computes camera
/// poses and reports the progress: see `poses::compute_poses`.
load_options scene_with_poses(const settings& s);

}  // namespace gs::cli
