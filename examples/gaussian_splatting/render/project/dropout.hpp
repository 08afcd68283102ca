// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/counter_hash.hpp"

namespace gs::raster {

/// Leaves random Gaussians out of a training step, so that no view can rely on a single Gaussian.
/// Source: DropGaussian (Park et al. 2025). The opacities of the others grow by `gain`, so that the
/// expected sum of opacities does not change.
struct dropout {
    std::uint32_t key = 0;    ///< selects the Gaussians; different in each step
    std::uint32_t limit = 0;  ///< Gaussians are left out whose hash of 16 bits is below it
    float gain = 1;           ///< factor of the other opacities

    dropout() = default;
    /// Leaves out a share of the Gaussians, in [0, 1).
    dropout(double share, std::uint32_t step_key)
        : key(step_key),
          limit(static_cast<std::uint32_t>(share * 65536)),
          gain(static_cast<float>(1 / (1 - share))) {}

    /// Returns in which lanes Gaussian i is left out. `Number` is the type of 32-bit unsigned
    /// integers of a warp.
    template <class Number>
    WARPAGG_HD auto leaves_out(const Number& i) const {
        return (counter_hash(i, key) & Number(0xffffu)) < Number(limit);
    }
};

}  // namespace gs::raster
