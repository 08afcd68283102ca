// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "../model/parameters.hpp"

namespace gs::train {

/// What may turn out not to be finite: the loss of a step, an element of a gradient, or what Adam would have
/// made of a parameter; or, where sums are in fixed point, not to fit: some warp's sum in a step.
enum class fault { loss, gradient, parameter, sum, count };
inline constexpr std::size_t fault_count = static_cast<std::size_t>(fault::count);

/// The earliest of its kind, and how many there were; the rest means nothing if there were none. Of several
/// in one iteration it is the one of the first parameter and Gaussian.
struct finding {
    std::uint64_t count = 0;
    int iteration = 0;
    gs::parameter parameter = gs::parameter::mean;
    std::uint32_t gaussian = 0;
};

/// By `fault`.
using findings = std::array<finding, fault_count>;

}  // namespace gs::train
