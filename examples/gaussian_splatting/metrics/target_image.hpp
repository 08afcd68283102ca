// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "../render/geometry/row_range.hpp"

namespace gs::train {

/// A photo on the device, with which renders are compared.
struct target_image {
    /// Premultiplied RGBA, 4 bytes per pixel, aligned to 4 bytes. The memory must exist while the
    /// target is in use.
    const std::uint8_t* rgba = nullptr;
    int width = 0, height = 0;
    std::array<float, 3> background{};  ///< color behind transparent pixels
    bool masked = false;                ///< whether pixels are masked: see image/masked_pixel.hpp
    row_range rows{};                   ///< the rows that are compared

    row_range compared_rows() const { return rows.within(height); }
};

}  // namespace gs::train
