// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/core/compiler.hpp>

#include "../geometry/splat.hpp"

namespace gs::raster {

/// The instances of one tile in the sorted list: [begin, end).
struct tile_range {
    std::uint32_t begin, end;
};

/// The tile lists of a view, which blending reads: for each tile, the splats that reach it, front
/// to back.
template <class Real>
struct tile_lists {
    const splat<Real>* splats;
    const std::uint32_t* gaussian_of;  ///< by place; the lists of all tiles follow one another
    const tile_range* ranges;          ///< by tile; each begins where the previous one ends
    unsigned tiles_across;
    int width, height;
};

}  // namespace gs::raster
