// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// An unsigned integer of as many bits as a Real.
template <class Real>
using bits_as = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// The bits of x as what else they may be. Those of a float as an integer are a sort key: non-negative floats
/// sort as their bits do. Of a lane value, of each lane's.
template <class Bits = std::uint32_t, class V>
WARPAGG_HD Bits bits_of(const V& x) {
    Bits bits;
    static_assert(sizeof bits == sizeof x);
    std::memcpy(&bits, &x, sizeof x);
    return bits;
}

}  // namespace gs::raster
