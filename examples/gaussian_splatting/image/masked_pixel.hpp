// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs {

/// The value of a masked pixel, as a little-endian word of RGBA. No other pixel has this value,
/// because a transparent white is not a premultiplied color.
inline constexpr std::uint32_t masked_pixel = 0x00ffffff;

}  // namespace gs
