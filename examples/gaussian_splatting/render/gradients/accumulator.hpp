// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs {

/// What memory keeps the sums of gradients in while the warps of the backward pass add to them. The values
/// number the variants of a `raster::accumulator_set`: these are the first two of every set.
enum class accumulator : std::uint8_t {
    native,  ///< floats: the fastest, but the order of additions changes the last bits
    fixed    ///< fixed-point numbers: the same bits in any order
};

}  // namespace gs
