// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/warp/concept.hpp>

#include "../render/geometry/row_range.hpp"
#include "../render/geometry/splat.hpp"

namespace gs::features {

/// Some rows of an image.
struct image_part {
    int width, height;
    row_range rows{};

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// The pixels of an image that one warp handles: one column per lane, `height` rows. Strips of tile
/// rows consist of whole patches, so that sums over patches do not depend on the division into strips.
template <class W>
struct pixel_patch {
    static constexpr int rows = 8;
    static_assert(raster::tile_size % rows == 0);

    unsigned left;              ///< the first column
    int first, last;            ///< range of rows, [first, last)
    warpagg::mask_t<W> inside;  ///< lanes whose column lies in the image

    /// Returns the number of patches of an image.
    static std::size_t count(int width, int height) {
        return across(width) * ((static_cast<std::size_t>(height) + rows - 1) / rows);
    }
    /// Returns the index of the first patch of some rows, and their number of patches.
    /// @{
    static unsigned first_in(const image_part& part) {
        return static_cast<unsigned>(count(part.width, part.rows.within(part.height).first));
    }
    static std::size_t count_in(const image_part& part) {
        return count(part.width, part.rows.within(part.height).last) - first_in(part);
    }
    /// @}

    WARPAGG_HD pixel_patch(const W& w, unsigned index, int width, int height) {
        left = index % across(width) * W::size;
        first = static_cast<int>(index / across(width)) * rows;
        last = first + rows < height ? first + rows : height;
        inside = w.lane() < static_cast<unsigned>(width) - left;
    }

  private:
    static WARPAGG_HD unsigned across(int width) {
        return (static_cast<unsigned>(width) + W::size - 1) / W::size;
    }
};

}  // namespace gs::features
