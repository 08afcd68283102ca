// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "ssim_window.hpp"

namespace gs::train {

/// Three planes of a picture's size in a frame of zeros, which is as wide as the window reaches: to the left
/// of a row lies the end of the one before, above a plane the end of the one before.
struct framed_planes {
    static constexpr int frame = ssim_window<float>::radius, alignment = 32;
    int width, height;

    WARPAGG_HD std::ptrdiff_t pitch() const {
        return (width + frame + alignment - 1) / alignment * alignment;
    }
    /// How many lines of `pitch()` values there are: one for the frame at the left of the first row, then the
    /// planes, each below its frame, then the frame of the last.
    WARPAGG_HD int lines() const { return 1 + 3 * (frame + height) + frame; }
    /// The place of a row's first pixel.
    WARPAGG_HD std::ptrdiff_t at(int channel, int row) const {
        return (1 + channel * (frame + height) + frame + row) * pitch();
    }
    /// How many values there are, with what the last lanes of a warp read of no use.
    std::size_t size() const { return static_cast<std::size_t>(lines() * pitch() + alignment); }
};

/// Columns as many as a warp has lanes, and some rows of a channel.
template <class W>
struct picture_strip {
    int channel, left, first, last;  ///< the rows are [first, last)
    mask_t<W> inside;                ///< lanes whose column the picture has

    /// How many rows a strip has if about `wanted` strips are to cover the picture. Lower ones spend too much
    /// on the rows above and below.
    static int rows_for(int width, int height, std::size_t wanted) {
        constexpr int least = 12;
        const auto chunks = static_cast<int>(std::max<std::size_t>(wanted / (3 * across(width)), 1));
        return std::max(least, (height + chunks - 1) / chunks);
    }
    static std::size_t count(int width, int height, int rows) {
        return 3 * across(width) * static_cast<std::size_t>((height + rows - 1) / rows);
    }

    WARPAGG_HD picture_strip(const W& w, unsigned index, int width, int height, int rows) {
        const auto chunks = static_cast<unsigned>((height + rows - 1) / rows);
        const auto columns = static_cast<unsigned>(across(width));
        left = static_cast<int>(index % columns * W::size);
        first = static_cast<int>(index / columns % chunks) * rows;
        last = first + rows < height ? first + rows : height;
        channel = static_cast<int>(index / columns / chunks);
        inside = w.lane() < static_cast<unsigned>(width - left);
    }

  private:
    static WARPAGG_HD std::size_t across(int width) {
        return (static_cast<unsigned>(width) + W::size - 1) / W::size;
    }
};

}  // namespace gs::train
