// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "blend_backward.hpp"
#include "gradient_policy.hpp"

namespace gs::raster {

/// Calls f with what the policy means, after a `blend_forward` that was cut up by `Cut`: a type whose member
/// `kernel` is the `blend_backward`, and `splits` whether it takes a warp for each segment.
template <class Real, class Cut, class F>
void with_policy(gradient_policy policy, const F& f) {
    using namespace warpagg;
    using single = pixel_a_lane<Cut>;
    using per_lane = warpagg::policy<reduce::per_lane>;
    using zeros = warpagg::policy<reduce::shfl_down, idle::add_zeros>;
    using skip = warpagg::policy<reduce::shfl_down, idle::assume_busy>;
    using scatter = warpagg::policy<reduce::scatter, idle::assume_busy>;
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
    }
}

}  // namespace gs::raster
