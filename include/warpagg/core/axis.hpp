// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The axes of a policy. Each tag has a member `axis`, the axis on which it selects.

/// Declares the object of a tag: a constant for host and device code.
#if defined(__CUDA_ARCH__)
#define WARPAGG_TAG static __device__ constexpr
#else
#define WARPAGG_TAG inline constexpr
#endif

namespace warpagg {

/// What a policy selects, with at most one tag per axis.
enum class axis {
    operation,   ///< how two values combine
    reduce,      ///< how the lanes' values become one
    accumulate,  ///< how a sum is kept
    commit,      ///< how the results reach memory
    idle,        ///< what an idle warp does
    gate,        ///< how many active lanes a reduction needs
};

}  // namespace warpagg
