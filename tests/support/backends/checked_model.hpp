// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <stdexcept>
#include <warpagg/warp/checked.hpp>

#include "host_memory.hpp"

namespace {

/// What the backends of the checked model have in common; see lanes.hpp.
template <class Warp>
struct checked_backend {
    using warp = Warp;
    static constexpr bool commits_in_lane_order = false;
    static constexpr unsigned every_nth_mask = 7;  // it takes its time
    template <class T>
    static constexpr bool packs() {
        return false;
    }

    template <class T>
    using memory = host_memory<T>;
    template <class T>
    using span = std::span<T>;

    template <class T>
    static T* shared(const warp& w, unsigned size) {
        return w.template shared<T>(size).data();
    }
    static void barrier(const warp& w) { w.barrier(); }

    static constexpr unsigned most_warps = 3;
    template <class F>
    static void launch_block(unsigned warps, const F& f) {
        const auto report = warpagg::emulator::try_launch<Warp>(
            {.threads = warps * Warp::size}, [&](const Warp& w) { f(w, w.thread_index() / Warp::size); });
        if (!report.ok()) throw std::runtime_error(report.text());
    }
    template <class F>
    static void launch(const F& f) {
        launch_block(1, [&](const Warp& w, unsigned) { f(w); });
    }
};

}  // namespace
