// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "image.hpp"

namespace gs {

image turned_upright(const image& stored, const orientation& turn) {
    image result = stored;
    if (turn.swaps_sides) std::swap(result.width, result.height);
    std::uint8_t* to = result.rgba.data();
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x, to += 4) {
            int from_x = turn.swaps_sides ? y : x, from_y = turn.swaps_sides ? x : y;
            if (turn.mirrors_x) from_x = stored.width - 1 - from_x;
            if (turn.mirrors_y) from_y = stored.height - 1 - from_y;
            const auto pixel = static_cast<std::size_t>(from_y) * static_cast<std::size_t>(stored.width) +
                               static_cast<std::size_t>(from_x);
            std::copy_n(&stored.rgba[4 * pixel], 4, to);
        }
    return result;
}

}  // namespace gs
