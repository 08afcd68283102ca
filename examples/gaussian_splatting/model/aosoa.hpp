// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// Device memory holds Gaussians as an array of structures of arrays: in a block of this many
/// Gaussians, the first component of all of them precedes their second one. A warp, or a SIMD
/// register, thus accesses neighbors in one piece, however many components a Gaussian has. (With
/// one row per Gaussian, each value that a thread writes would cost a memory sector of 32 bytes.)
inline constexpr std::size_t block_length = 32;

/// The number of Gaussians rounded up to whole blocks, for which arrays have memory.
constexpr std::size_t in_whole_blocks(std::size_t count) {
    return (count + block_length - 1) / block_length * block_length;
}

/// The index of component k of Gaussian i in an array with `width` components per Gaussian.
WARPAGG_HD constexpr std::size_t aosoa_index(std::size_t i, std::size_t k, std::size_t width) {
    return i / block_length * block_length * width + i % block_length + k * block_length;
}

/// Copies the first `width` values of each of `count` rows, which are `stride` apart, into blocks.
/// Padding is zero.
template <class Real>
std::vector<Real> to_blocks(const Real* rows, std::size_t count, std::size_t stride, std::size_t width) {
    std::vector<Real> blocks(in_whole_blocks(count) * width);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) blocks[aosoa_index(i, k, width)] = rows[i * stride + k];
    return blocks;
}

/// The inverse of `to_blocks`.
template <class Real>
void from_blocks(const Real* blocks, std::size_t count, std::size_t stride, std::size_t width, Real* rows) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) rows[i * stride + k] = blocks[aosoa_index(i, k, width)];
}

}  // namespace gs
