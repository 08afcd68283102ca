// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace gs::train {

/// A photo on the device that renders are compared with.
struct target_image {
    /// Premultiplied RGBA, 4 bytes per pixel, aligned to 4 bytes. Must stay on the device while it
    /// is in use.
    const std::uint8_t* rgba = nullptr;
    int width = 0, height = 0;
    std::array<float, 3> background{};  ///< the photo is shown in front of this color
    bool masked = false;                ///< some pixels are excluded: see image/masked_pixel.hpp
};

}  // namespace gs::train
