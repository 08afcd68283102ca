// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "../model/parameters.hpp"

namespace gs::train {

/// The precision of Adam's moments. `compact` takes 112 instead of 472 bytes per Gaussian of SH degree 3:
///
/// - A first and a second moment of a position, a scale, a rotation or an opacity share a word. Each
///   is the upper half of a float.
/// - The color channels of an SH coefficient share a second moment. Their first moments are multiples
///   of its root, in fixed point of 10 bits.
/// - All SH coefficients of a Gaussian share that second moment. The squares of the basis functions of
///   each SH degree l sum to (2 l + 1) / (4 pi) in all directions (Unsöld 1927), so that their mean is
///   the same for all degrees, and so is the mean of the squared gradients.
///
/// Values are rounded up or down at random, so that their mean is exact.
enum class moment_precision { full, compact };

constexpr std::array<std::string_view, 2> names_of(moment_precision) { return {"float", "compact"}; }

/// Number of words of compact moments per Gaussian, by parameter. SH degree 0 has one word for its first
/// moments and one for the second moment of all SH degrees. The other degrees have one word for each
/// coefficient.
inline constexpr std::array<int, parameter_count> packed_width{3, 3, 4, 1, 2, 3, 5, 7};

}  // namespace gs::train
