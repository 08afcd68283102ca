// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/simt/target.hpp>

namespace gs::raster {

/// The bits of a float as a sort key: non-negative floats sort as their bits do.
WARPAGG_HD std::uint32_t bits_of(float x) {
#if defined(__CUDA_ARCH__)
    return __float_as_uint(x);
#else
    return __builtin_bit_cast(std::uint32_t, x);
#endif
}

}  // namespace gs::raster
