// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "../model/parameters.hpp"

namespace gs::train {

/// The kinds of faults in a step:
/// - `loss`: the loss is not finite.
/// - `gradient`: an element of a gradient is not finite or too large to square.
/// - `parameter`: a parameter would not be finite after Adam's step.
/// - `sum`: a fixed-point sum of gradients exceeds its range: see `loss::gradient_scale`.
enum class fault_kind { loss, gradient, parameter, sum, count };
inline constexpr std::size_t fault_kind_count = static_cast<std::size_t>(fault_kind::count);

/// The number of faults of one kind, and the earliest of them. Within an iteration, the fault with
/// the first parameter, and then with the first Gaussian, counts as the earliest. Without faults,
/// the other members are undefined.
struct fault_report {
    std::uint64_t count = 0;
    int iteration = 0;
    gs::parameter parameter = gs::parameter::mean;
    std::uint32_t gaussian = 0;
};

/// One report per `fault_kind`.
using fault_reports = std::array<fault_report, fault_kind_count>;

}  // namespace gs::train
