// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gs::cluster {

/// 256 numbers that represent many others with a small mean squared error, in ascending order.
class codebook {
  public:
    static constexpr std::size_t size = 256;

    /// Fits the numbers to `values`, which are finite: merges similar values, and partitions the rest
    /// with the smallest possible error. Reads a sample of about half a million values if there are
    /// more. Takes the time of sorting. Without values, all numbers are zero.
    explicit codebook(std::span<const float> values);

    const std::array<float, size>& values() const { return values_; }
    /// Returns the index of the nearest number.
    std::uint8_t nearest(float x) const;

  private:
    std::array<float, size> values_{};
    std::array<float, size - 1> limits_{};  ///< halfway between neighbors
};

}  // namespace gs::cluster
