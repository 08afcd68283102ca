// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// The unsigned integer type with the size of `Real`, 4 or 8 bytes.
template <class Real>
using bits_as = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// Returns the bits of x as an integer, or as another type of this size, lane by lane for SIMD values.
/// The bits of non-negative floats have the order of the floats, so they can serve as a sort key.
template <class Bits = std::uint32_t, class V>
WARPAGG_HD Bits bits_of(const V& x) {
    Bits bits;
    static_assert(sizeof bits == sizeof x);
    std::memcpy(&bits, &x, sizeof x);
    return bits;
}

}  // namespace gs::raster
