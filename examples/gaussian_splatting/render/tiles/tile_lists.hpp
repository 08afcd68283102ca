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

/// What a view's blending reads: the image's tiles, and for each the splats that it meets, front to back.
template <class Real>
struct tile_lists {
    const splat<Real>* splats;
    const std::uint32_t* gaussian_of;  ///< by place in the list of all tiles
    const tile_range* ranges;          ///< by tile; each begins where the one before ends
    unsigned tiles_across;
    int width, height;
};

}  // namespace gs::raster
