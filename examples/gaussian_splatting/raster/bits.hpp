// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <warpagg/simt/target.hpp>

namespace gs::raster {

/// The bits of a float as a sort key: non-negative floats sort as their bits do. Of a lane value, of each
/// lane's.
template <class Bits = std::uint32_t, class V>
WARPAGG_HD Bits bits_of(const V& x) {
    Bits bits;
    static_assert(sizeof bits == sizeof x);
    std::memcpy(&bits, &x, sizeof x);
    return bits;
}

}  // namespace gs::raster
