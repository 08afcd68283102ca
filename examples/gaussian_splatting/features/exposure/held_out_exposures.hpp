// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"
#include "exposure_kernels.hpp"

namespace gs::features {

/// Estimates the exposures of the held-out photos from those of the training photos. The estimate
/// is the mean of the previous and the next photo in the order of names, because neighbors on a
/// walk or in a film are similar. If this rule predicts the exposures of training photos worse than
/// the identity does, all estimates are the identity. `of_training` has one entry per training
/// view.
std::vector<exposure> held_out_exposures(const scene& scene, const std::vector<exposure>& of_training);

}  // namespace gs::features
