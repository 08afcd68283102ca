// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/image.hpp"

namespace gs_test {

using pixel = std::array<std::uint8_t, 4>;

inline pixel pixel_at(const gs::image& from, int x, int y) {
    const auto i = 4 * static_cast<std::size_t>(y * from.width + x);
    return {from.rgba[i], from.rgba[i + 1], from.rgba[i + 2], from.rgba[i + 3]};
}

}  // namespace gs_test
