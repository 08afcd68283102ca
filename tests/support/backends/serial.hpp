// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <warpagg/warp/serial.hpp>

#include "host_memory.hpp"

namespace {

/// See lanes.hpp. The warp has one lane.
struct backend {
    using warp = warpagg::emulator::serial;
    static constexpr const char* name = "serial";
    static constexpr bool commits_in_lane_order = true;
    static constexpr unsigned every_nth_mask = 1;
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

    static constexpr unsigned most_warps = 1;
    template <class F>
    static void launch_block(unsigned, const F& f) {
        f(warp{}, 0u);
    }
    template <class F>
    static void launch(const F& f) {
        f(warp{});
    }
};

}  // namespace
