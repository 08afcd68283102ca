// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

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

}  // namespace gs::train
