// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs {

/// A pixel that a mask leaves out, as a little-endian word of RGBA: white and transparent, which no
/// premultiplied colour is.
inline constexpr std::uint32_t left_out = 0x00ffffff;

}  // namespace gs
