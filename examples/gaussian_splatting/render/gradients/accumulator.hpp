// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs {

/// How gradient sums are kept in memory while the warps of the backward pass add to them. A value
/// is the index of a variant in a `raster::accumulator_set`; the two below are the first variants
/// of every set.
enum class accumulator : std::uint8_t {
    native,  ///< floats: fastest, but the last bits depend on the order of additions
    fixed    ///< fixed point: the bits do not depend on the order of additions
};

}  // namespace gs
