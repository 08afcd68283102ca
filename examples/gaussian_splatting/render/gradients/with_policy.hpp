// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "../blend/blend_backward.hpp"
#include "gradient_policy.hpp"

namespace gs::raster {

/// In units of 2^-45 of the largest sum there may be; of as many warps as a picture of 16 million pixels has
/// patches.
inline constexpr int fixed_log_warps = 18;
using fixed_sums = warpagg::accumulate::fixed<63 - fixed_log_warps, fixed_log_warps>;

/// The kernel that does the same before a colour a pixel, where there is one: of split lists, whose sums are
/// kept in float or in fixed point.
template <class Kernel>
struct before_colours {
    static constexpr bool is_there = false;
};
template <class Real, class Cut, class Policy, bool AskFirst>
requires(std::is_same_v<sum_in_memory<Real, Policy>, Real> ||
         std::is_same_v<sum_in_memory<Real, Policy>,
                        warpagg::cell<fixed_sums>>) struct before_colours<blend_backward<Real, Cut, true,
                                                                                         Policy, AskFirst>> {
    static constexpr bool is_there = true;
    using type = blend_backward<Real, Cut, true, Policy, AskFirst, colour_a_pixel<Real>>;
};

/// Calls f with the `blend_backward` that the policy means, after a `blend_forward` that was cut up by `Cut`.
/// In double sums are never kept otherwise than in double.
template <class Real, class Cut, class F>
void with_policy(gradient_policy policy, const F& f) {
    using namespace warpagg;
    using single = pixel_a_lane<Cut>;
    using per_lane = warpagg::policy<reduce::per_lane>;
    using zeros = warpagg::policy<reduce::shfl_down, idle::add_zeros>;
    using skip = warpagg::policy<reduce::shfl_down, idle::assume_busy>;
    using scatter = warpagg::policy<reduce::scatter, idle::assume_busy>;
    const auto split_as = [&]<class Kept>(Kept) {
        using kept = std::conditional_t<std::is_same_v<Real, float>, accumulate::between_warps<Kept>,
                                        accumulate::native>;
        using split = warpagg::policy<reduce::scatter, idle::assume_busy, kept>;
        return f(blend_backward<Real, Cut, true, split, true>{});
    };
    switch (policy) {
        case gradient_policy::per_lane:
            return f(blend_backward<Real, single, false, per_lane, false>{});
        case gradient_policy::reduce:
            return f(blend_backward<Real, single, false, zeros, false>{});
        case gradient_policy::reduce_skip:
            return f(blend_backward<Real, single, false, skip, true>{});
        case gradient_policy::scatter:
            return f(blend_backward<Real, single, false, scatter, true>{});
        case gradient_policy::split:
            return f(blend_backward<Real, Cut, true, scatter, true>{});
        case gradient_policy::f64:
            return split_as(accumulate::f64{});
        case gradient_policy::compensated:
            return split_as(accumulate::compensated{});
        case gradient_policy::fixed:
            return split_as(fixed_sums{});
        case gradient_policy::binned:
            return split_as(accumulate::binned<2>{});
        case gradient_policy::exact:
            return split_as(accumulate::exact{});
    }
}

}  // namespace gs::raster
