// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../scene/scene_statistics.hpp"
#include "../explanation.hpp"

namespace gs::features {

/// Explains whether colors depend on the viewing direction: the gain of each SH degree, and the
/// points that `degree`, from 1 to 3, explains best.
explanation explain_direction(const scene_statistics& statistics, int degree);

}  // namespace gs::features
