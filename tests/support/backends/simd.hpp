// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <warpagg/warp/simd.hpp>

#include "host_memory.hpp"

namespace {

/// What the backends of SIMD lanes have in common; see lanes.hpp.
template <class Warp>
struct simd_backend {
    using warp = Warp;
    static constexpr bool commits_in_lane_order = true;
    /// Every nth of all masks is tried.
    static constexpr unsigned every_nth_mask = 1;
    /// States whether `commit::packed` applies to aligned records of T.
    template <class T>
    static constexpr bool packs() {
        return false;
    }

    template <class T>
    using memory = host_memory<T>;
    template <class T>
    using span = std::span<T>;

    /// The block's memory of `size` values, and the block's barrier.
    /// @{
    template <class T, class W>
    static T* shared(const W&, unsigned size) {
        static thread_local std::vector<T> memory;
        memory.assign(size, T{});
        return memory.data();
    }
    template <class W>
    static void barrier(const W&) {}
    /// @}

    template <class F>
    static void launch(const F& f) {
        f(Warp{});
    }
};

}  // namespace
