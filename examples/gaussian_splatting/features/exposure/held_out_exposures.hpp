// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"
#include "exposure_kernels.hpp"

namespace gs::features {

/// How the test photos were exposed, as far as training photos tell: as the mean of those before and after
/// each in the order of names, which along a walk or in a film are alike. Where exposures of training photos
/// are predicted worse so than by no change, none changes anything. `of_training`: one a training view.
std::vector<exposure> held_out_exposures(const scene& scene, const std::vector<exposure>& of_training);

}  // namespace gs::features
