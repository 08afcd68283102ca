// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"
#include "exposure_kernels.hpp"

namespace gs::features {

/// Estimates the exposures of the held-out photos from those of the training photos: the mean of the
/// previous and the next one in the order of names, since neighbors on a walk or in a film are alike.
/// All are the identity if this rule predicts the exposures of the training photos worse than the
/// identity does. `of_training` has one entry per training view.
std::vector<exposure> held_out_exposures(const scene& scene, const std::vector<exposure>& of_training);

}  // namespace gs::features
