// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "morton_order.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "../core/parallel.hpp"

namespace gs {
namespace {

constexpr int bits_per_axis = 21;

/// Moves bit i of a number below 2^21 to bit 3 i.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const std::vector<float>& positions) {
    const std::size_t count = positions.size() / 3;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double low = 0, high = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double x = positions[3 * i + axis];
            low = i == 0 ? x : std::min(low, x);
            high = i == 0 ? x : std::max(high, x);
        }
        const double cells = (std::uint64_t{1} << bits_per_axis) - 1;
        const double scale = high > low ? cells / (high - low) : 0;
        for_each_index_in_parallel(count, [&](std::size_t i) {
            const double x = positions[3 * i + axis];
            keys[i].first |= spread(static_cast<std::uint64_t>((x - low) * scale)) << axis;
            keys[i].second = static_cast<std::uint32_t>(i);
        });
    }
    sort_in_parallel(keys);
    std::vector<std::uint32_t> order(count);
    for (std::size_t i = 0; i < count; ++i) order[i] = keys[i].second;
    return order;
}

}  // namespace gs
