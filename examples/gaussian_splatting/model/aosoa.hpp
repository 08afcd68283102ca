// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// On a device Gaussians lie in blocks of this many, in which a component of all of them comes before the
/// next component: a warp, or a SIMD register, reads and writes neighbours in one piece, however many values
/// a Gaussian has. (A thread that writes a row of its own costs the memory a sector of 32 bytes a value.)
inline constexpr std::size_t block_length = 32;

/// For how many Gaussians there is memory: the last block is a whole one.
constexpr std::size_t in_whole_blocks(std::size_t count) {
    return (count + block_length - 1) / block_length * block_length;
}

/// Where component k of Gaussian i lies in an array of `width` components.
WARPAGG_HD constexpr std::size_t place(std::size_t i, std::size_t k, std::size_t width) {
    return i / block_length * block_length * width + i % block_length + k * block_length;
}

/// Into blocks, of `count` rows that are `stride` apart the `width` values from the first; the places past
/// the end are zero.
template <class Real>
std::vector<Real> to_blocks(const Real* rows, std::size_t count, std::size_t stride, std::size_t width) {
    std::vector<Real> blocks(in_whole_blocks(count) * width);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) blocks[place(i, k, width)] = rows[i * stride + k];
    return blocks;
}

/// And back.
template <class Real>
void from_blocks(const Real* blocks, std::size_t count, std::size_t stride, std::size_t width, Real* rows) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k) rows[i * stride + k] = blocks[place(i, k, width)];
}

}  // namespace gs
