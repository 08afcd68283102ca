// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../growth/growth.hpp"

namespace gs::train {

/// Thresholds of one densification, which decide when a Gaussian is cloned, split or removed (Kerbl
/// et al. 2023, section 5.2). Unlike the paper, it removes no Gaussian for its size, because
/// distant Gaussians are large.
struct densify_config {
    /// The mean gradient of its center, in halves of the image, from which a Gaussian grows.
    float gradient = 1e-4f;
    float dense_scale = 0;         ///< largest cloned scale, in internal units; larger are split
    float least_opacity = 0.005f;  ///< opacity below which Gaussians are removed
    growth_limits limits;
};

}  // namespace gs::train
