// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs {

/// A pixel that a mask excludes, as a little-endian word of RGBA. White and transparent is not a
/// premultiplied color, so no other pixel has this value.
inline constexpr std::uint32_t masked_pixel = 0x00ffffff;

}  // namespace gs
