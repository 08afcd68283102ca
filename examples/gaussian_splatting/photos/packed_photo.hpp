// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "../scene/scene.hpp"

namespace gs::photos {

/// Returns the number of bytes of a packed photo: its pixels, and then the values of its depth map,
/// if it has one. It is a multiple of 16, so that the pixels of photos in a row are aligned.
inline std::size_t packed_bytes(const camera& size, bool has_depths) {
    const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    return ((has_depths ? 6 : 4) * pixels + 15) / 16 * 16;
}

/// Returns the number of bytes of the photo of a streamed view that stays in host memory, in full size.
inline std::size_t kept_bytes(const view& v) {
    return v.plane_bytes > 0 ? v.plane_bytes : packed_bytes(v.camera, v.depths.is_there());
}

/// Returns the index of the first byte of the depth map in a packed photo.
inline std::size_t depths_offset(const camera& size) {
    return 4 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// Packs a photo. Precondition: `to` has `packed_bytes`.
inline void pack(const image& pixels, const depth_map& depths, std::uint8_t* to) {
    std::copy(pixels.rgba.begin(), pixels.rgba.end(), to);
    if (depths.is_there())
        std::memcpy(to + pixels.rgba.size(), depths.values.data(),
                    depths.values.size() * sizeof(std::uint16_t));
}

}  // namespace gs::photos
