// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <warpagg/simt/serial.hpp>

#include "host_memory.hpp"

namespace {

/// See lanes.hpp. The warp has one lane.
struct backend {
    using warp = warpagg::emulator::serial;
    static constexpr const char* name = "serial";
    static constexpr bool commits_in_lane_order = true;

    template <class T>
    using memory = host_memory<T>;
    template <class T>
    using span = std::span<T>;

    template <class F>
    static void launch(const F& f) {
        f(warp{});
    }
};

}  // namespace
