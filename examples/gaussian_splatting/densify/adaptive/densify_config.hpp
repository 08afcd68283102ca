// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace gs::train {

/// Thresholds of one densification, which decide when a Gaussian is cloned, split or removed (Kerbl
/// et al. 2023, section 5.2). Unlike the paper, it removes no Gaussian for its size, because
/// distant Gaussians are large.
struct densify_config {
    /// The mean gradient of its center, in halves of the image, from which a Gaussian grows.
    float gradient = 1e-4f;
    float dense_scale = 0;         ///< largest cloned scale, in internal units; larger are split
    float least_opacity = 0.005f;  ///< opacity below which Gaussians are removed
    std::size_t cap = 0;           ///< largest number of Gaussians to which the model grows
    /// Largest number of new Gaussians. Those with the largest gradients grow first.
    std::size_t most_births = std::numeric_limits<std::size_t>::max();
    /// Makes a Gaussian and its clone together as opaque as the Gaussian was (Rota Bulo et al.
    /// 2024).
    bool revised_opacity = true;
    std::uint64_t seed = 0;  ///< seed, with `step`, of the random positions after a split
    std::uint64_t step = 0;
};

}  // namespace gs::train
