// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// The number of Gaussians per AoSoA block. Device memory holds Gaussians as an array of structures
/// of arrays: in a block, the first components of all Gaussians precede their second components. A
/// warp or a SIMD register therefore accesses contiguous memory for any number of components. With
/// one row per Gaussian, each value that a thread writes would cost a memory sector of 32 bytes.
inline constexpr std::size_t block_length = 32;

/// Returns the number of Gaussians, rounded up to whole blocks. Arrays have memory for that number.
constexpr std::size_t in_whole_blocks(std::size_t count) {
    return (count + block_length - 1) / block_length * block_length;
}

/// Returns the index of component k of Gaussian i in an array with `width` components per Gaussian.
WARPAGG_HD constexpr std::size_t aosoa_index(std::size_t i, std::size_t k, std::size_t width) {
    return i / block_length * block_length * width + i % block_length + k * block_length;
}

/// Copies the first `width` values of each of `count` rows, which are `stride` values apart, into
/// AoSoA blocks. Padding is zero.
template <class Real>
std::vector<Real> to_blocks(const Real* rows, std::size_t count, std::size_t stride, std::size_t width) {
    std::vector<Real> blocks(in_whole_blocks(count) * width);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) blocks[aosoa_index(i, k, width)] = rows[i * stride + k];
    return blocks;
}

/// Copies AoSoA blocks to rows, as the inverse of `to_blocks`.
template <class Real>
void from_blocks(const Real* blocks, std::size_t count, std::size_t stride, std::size_t width, Real* rows) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) rows[i * stride + k] = blocks[aosoa_index(i, k, width)];
}

}  // namespace gs
