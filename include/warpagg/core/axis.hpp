// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The axes of a policy. Each tag has a static member `axis` that names its axis.

#include "compiler.hpp"

/// Declares the object of a tag as a constant for host and device code.
#if defined(__CUDA_ARCH__)
#define WARPAGG_TAG static __device__ constexpr
#else
#define WARPAGG_TAG inline constexpr
#endif

namespace warpagg {

/// The settings of a policy. A policy has at most one tag per axis.
enum class axis {
    operation,   ///< how two values combine
    reduce,      ///< how the values of the lanes are reduced to one
    accumulate,  ///< how a sum is kept, in the warp and in memory
    commit,      ///< how the results reach memory
    idle,        ///< behavior of an idle warp
    gate,        ///< how many active lanes a reduction needs
    scope,       ///< the threads that see the atomics
};

namespace detail {

/// Is satisfied by every `policy`.
template <class P>
concept is_policy = requires {
    typename P::reduce;
    typename P::gate;
};

/// Is true for the tag of every accumulator but `native`.
template <class Accumulate>
inline constexpr bool is_accumulated = requires {
    typename Accumulate::limb;
};

}  // namespace detail
}  // namespace warpagg
