// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// The unsigned integer with as many bits as a Real.
template <class Real>
using bits_as = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// Reinterprets the bits of x, for lane values in each lane. As integers, the bits of non-negative
/// floats are a sort key.
template <class Bits = std::uint32_t, class V>
WARPAGG_HD Bits bits_of(const V& x) {
    Bits bits;
    static_assert(sizeof bits == sizeof x);
    std::memcpy(&bits, &x, sizeof x);
    return bits;
}

}  // namespace gs::raster
