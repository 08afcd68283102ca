// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "backend.hpp"

namespace hard_cases {

/// Compares the reference's gradients with central differences.
struct verdict {
    std::size_t right = 0, wrong = 0;
    std::size_t straddling = 0;  ///< a threshold lies within the step: two steps disagree
    std::string first_wrong;

    void operator+=(const verdict& other);
};

/// Compares the gradients of the loss by these Gaussians' parameters, each alone, and by all parameters along
/// a random direction, with differences of step 1e-6, to a relative 1e-5 (and, for what rounding of the loss
/// leaves of a difference, to 5e-10 and 1e-7 of the parameter's largest).
verdict check_by_differences(const render_case& q, const std::vector<std::size_t>& gaussians, unsigned seed);

}  // namespace hard_cases
