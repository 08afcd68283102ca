// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace gs::train {

/// Thresholds of one densification: when a Gaussian is copied, split or removed (Kerbl et al. 2023, section
/// 5.2). In contrast to the paper none is removed for its size, since distant Gaussians are large.
struct densify_config {
    float gradient = 1e-4f;  ///< grows from this mean gradient of its center, in halves of the image
    float dense_scale = 0;   ///< world units: up to this scale a growing Gaussian is copied, above it split
    float least_opacity = 0.005f;  ///< removes Gaussians below it
    std::size_t cap = 0;           ///< no growth beyond this number of Gaussians
    /// Limits the number of new Gaussians; those with the largest gradients grow first.
    std::size_t most_births = std::numeric_limits<std::size_t>::max();
    /// A copied Gaussian and its copy together are as opaque as it was alone (Rota Bulo et al. 2024).
    bool revised_opacity = true;
    std::uint64_t seed = 0;  ///< with `step`, of the positions that the halves of a split draw
    std::uint64_t step = 0;
};

}  // namespace gs::train
