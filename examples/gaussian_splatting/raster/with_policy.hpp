// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <warpagg/atomic.hpp>

#include "gradient_policy.hpp"

namespace gs::raster {

/// Calls f with what the policy means: the library's policy, and whether idle warps are skipped before
/// anything is computed (see `blend_backward`), as a std::bool_constant.
template <class F>
void with_policy(gradient_policy policy, const F& f) {
    using namespace warpagg;
    switch (policy) {
        case gradient_policy::per_lane:
            return f(warpagg::policy<reduce::per_lane>{}, std::false_type{});
        case gradient_policy::reduce:
            return f(warpagg::policy<reduce::shfl_down, idle::add_zeros>{}, std::false_type{});
        case gradient_policy::reduce_skip:
            return f(warpagg::policy<reduce::shfl_down, idle::assume_busy>{}, std::true_type{});
        case gradient_policy::scatter:
            return f(warpagg::policy<reduce::scatter, idle::assume_busy>{}, std::true_type{});
    }
}

}  // namespace gs::raster
