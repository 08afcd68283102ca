// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "../render/geometry/row_range.hpp"
#include "ssim_window.hpp"

namespace gs::train {

/// Three planes of an image's size, each surrounded by a frame of zeros as wide as the radius of
/// the SSIM's window. Rows and planes share their frames: the zeros to the left of a row are those
/// at the end of the previous row, and the zeros above a plane are those below the previous plane.
struct framed_planes {
    static constexpr int frame = ssim_window<float>::radius, alignment = 32;
    int width, height;

    WARPAGG_HD std::ptrdiff_t pitch() const {
        return (width + frame + alignment - 1) / alignment * alignment;
    }
    /// Returns the number of lines of `pitch()` values: one for the frame to the left of the first
    /// row, then each plane with the frame above it, then the frame below the last plane.
    WARPAGG_HD int lines() const { return 1 + 3 * (frame + height) + frame; }
    /// Returns the index of a row's first pixel.
    WARPAGG_HD std::ptrdiff_t at(int channel, int row) const {
        return (1 + channel * (frame + height) + frame + row) * pitch();
    }
    /// Returns the number of values, including padding at the end that the last lanes of a warp
    /// read and ignore.
    std::size_t size() const { return static_cast<std::size_t>(lines() * pitch() + alignment); }
};

/// The part of an image that one warp processes: some columns and rows of one channel. The strips
/// cover the `within` rows of the image.
template <class W, int Columns = static_cast<int>(W::size)>
struct ssim_strip {
    int channel, left, first, last;  ///< the rows are [first, last)
    mask_t<W> inside;                ///< with one column per lane: lanes whose column is in the image

    /// Returns the number of rows per strip for about `wanted` strips, at least 12. In lower
    /// strips, the rows above and below them would take too much of the time.
    static int rows_for(int width, int height, std::size_t wanted) {
        constexpr int least = 12;
        const auto chunks = static_cast<int>(std::max<std::size_t>(wanted / (3 * across(width)), 1));
        return std::max(least, (height + chunks - 1) / chunks);
    }
    static std::size_t count(int width, const row_range& within, int rows) {
        return 3 * across(width) * static_cast<std::size_t>((within.count() + rows - 1) / rows);
    }

    WARPAGG_HD ssim_strip(const W& w, unsigned index, int width, const row_range& within, int rows) {
        const auto chunks = static_cast<unsigned>((within.last - within.first + rows - 1) / rows);
        const auto columns = static_cast<unsigned>(across(width));
        left = static_cast<int>(index % columns) * Columns;
        first = within.first + static_cast<int>(index / columns % chunks) * rows;
        last = first + rows < within.last ? first + rows : within.last;
        channel = static_cast<int>(index / columns / chunks);
        inside = w.lane() < static_cast<unsigned>(width - left);
    }

  private:
    static WARPAGG_HD std::size_t across(int width) {
        constexpr auto columns = static_cast<unsigned>(Columns);
        return (static_cast<unsigned>(width) + columns - 1) / columns;
    }
};

}  // namespace gs::train
