// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <warpagg/atomic.hpp>

#include "../../core/error.hpp"
#include "../blend/blend_backward.hpp"
#include "accumulator.hpp"

namespace gs::raster {

/// A variant of the backward pass that splits tile lists over warps and keeps sums as `Real`.
struct native_sums {
    /// Whether the kernel also exists for an `image_background`.
    static constexpr bool supports_background_image = true;
    template <class Real, class Cut, class Backdrop = constant_background<Real>>
    using kernel =
        blend_backward<Real, Cut, true, warpagg::policy<warpagg::reduce::scatter, warpagg::idle::assume_busy>,
                       true, Backdrop>;
};

/// The same variant with the sums of warps accumulated in `Accumulate`. If `Real` is double, sums
/// stay double.
template <class Accumulate, bool SupportsBackdrop = true>
struct sums_kept_in {
    static constexpr bool supports_background_image = SupportsBackdrop;
    template <class Real>
    using kept =
        std::conditional_t<std::is_same_v<Real, float>, warpagg::accumulate::between_warps<Accumulate>,
                           warpagg::accumulate::native>;
    template <class Real, class Cut, class Backdrop = constant_background<Real>>
    using kernel =
        blend_backward<Real, Cut, true,
                       warpagg::policy<warpagg::reduce::scatter, warpagg::idle::assume_busy, kept<Real>>,
                       true, Backdrop>;
};

/// Sums in fixed point. The unit is 2^-45 of the largest sum of a warp. Up to 2^18 warps may add to
/// one sum; with 64 pixels per patch, this is an image of 16 million pixels.
inline constexpr int fixed_log_warps = 18;
using fixed_sums = warpagg::accumulate::fixed<63 - fixed_log_warps, fixed_log_warps>;

/// The variants that a renderer is compiled for. An `accumulator` is the index of a variant.
template <class... Variants>
struct accumulator_set {
    /// Calls `f` with an object of the chosen variant. Throws `error` if the set has no such
    /// variant.
    template <class F>
    static void visit(accumulator chosen, const F& f) {
        auto left = static_cast<std::size_t>(chosen);
        const bool found = ((left-- == 0 && (f(Variants{}), true)) || ...);
        if (!found)
            throw error("this program has " + std::to_string(sizeof...(Variants)) +
                        " accumulators, but number " + std::to_string(static_cast<int>(chosen)) +
                        " was requested (they are numbered from 0)");
    }
    /// Calls `f` with the `blend_backward` kernel of the chosen variant, for a constant background.
    /// Precondition of the kernel: a `blend_forward` with the same `Cut` has run.
    template <class Real, class Cut, class F>
    static void with_kernel(accumulator chosen, const F& f) {
        visit(chosen, [&]<class Variant>(Variant) { f(typename Variant::template kernel<Real, Cut>{}); });
    }
    static constexpr bool supports_background_image(accumulator chosen) {
        constexpr std::array supports{Variants::supports_background_image...};
        return supports[static_cast<std::size_t>(chosen)];
    }
};

/// The variants of the trainer, in the order of `accumulator`.
using product_accumulators = accumulator_set<native_sums, sums_kept_in<fixed_sums>>;

}  // namespace gs::raster
