// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// What a policy's tags have in common: each names the axis that it chooses on.

/// Before an object of a tag: it is a constant that host and device code may name.
#if defined(__CUDA_ARCH__)
#define WARPAGG_TAG static __device__ constexpr
#else
#define WARPAGG_TAG inline constexpr
#endif

namespace warpagg {

/// What a policy chooses: one tag at most on each axis.
enum class axis {
    operation,   ///< what values are combined by
    reduce,      ///< how the lanes' values become one
    accumulate,  ///< in what a sum is kept
    commit,      ///< how the results reach memory
    idle,        ///< what happens when no lane is active
    gate,        ///< from how many active lanes on the reduction is worth it
};

}  // namespace warpagg
