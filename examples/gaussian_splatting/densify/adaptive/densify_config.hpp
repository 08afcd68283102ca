// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace gs::train {

/// When a Gaussian is copied, split or dropped (Kerbl et al. 2023, section 5.2; what lego has by their
/// threshold of 2e-4 and by lower ones: docs/gaussian_splatting.md). None is dropped for its size, as theirs
/// are: what is far away is large.
struct densify_rule {
    float gradient = 1e-4f;  ///< grows at this mean gradient of its centre, in halves of the picture
    float dense_scale = 0;   ///< world units: a growing Gaussian up to this is copied, a larger one split
    float least_opacity = 0.005f;  ///< drops below it
    std::size_t cap = 0;           ///< no growth past this many
    /// At once, the most urgent first.
    std::size_t most_births = std::numeric_limits<std::size_t>::max();
    /// A copied Gaussian and its copy are together as opaque as it was alone (Rota Bulo et al. 2024).
    bool revised_opacity = true;
    std::uint64_t seed = 0;  ///< where the halves of a split come to lie
    std::uint64_t step = 0;
};

}  // namespace gs::train
