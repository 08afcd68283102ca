// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace gs::train {

/// A photo on the device, with which renders are compared.
struct target_image {
    /// Premultiplied RGBA, 4 bytes per pixel, aligned to 4 bytes. The memory must exist while the
    /// target is in use.
    const std::uint8_t* rgba = nullptr;
    int width = 0, height = 0;
    std::array<float, 3> background{};  ///< color behind transparent pixels
    bool masked = false;                ///< whether pixels are masked: see image/masked_pixel.hpp
};

}  // namespace gs::train
