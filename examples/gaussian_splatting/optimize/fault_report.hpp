// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "../model/parameters.hpp"

namespace gs::train {

/// What went wrong in a step:
/// - `loss`: the loss is not finite.
/// - `gradient`: an element of a gradient is not finite or too large to square.
/// - `parameter`: a parameter would not be finite after Adam's step.
/// - `sum`: with fixed-point sums, a sum of gradients exceeds their range: see
///   `loss::gradient_scale`.
enum class fault_kind { loss, gradient, parameter, sum, count };
inline constexpr std::size_t fault_kind_count = static_cast<std::size_t>(fault_kind::count);

/// The faults of one kind: their number and the earliest one. Within an iteration, the one of the
/// first parameter, and of its first Gaussian, counts as the earliest. Without faults the other
/// members are undefined.
struct fault_report {
    std::uint64_t count = 0;
    int iteration = 0;
    gs::parameter parameter = gs::parameter::mean;
    std::uint32_t gaussian = 0;
};

/// By `fault_kind`.
using fault_reports = std::array<fault_report, fault_kind_count>;

}  // namespace gs::train
