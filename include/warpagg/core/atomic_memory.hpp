// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

#include "operation.hpp"

namespace warpagg::emulator::detail {

/// Atomically sets `*to = Op::combine(*to, v)` on the CPU, with relaxed order. Atomic, because an
/// emulator may run warps on several threads. Cost: a compare-and-swap loop; one `fetch_add` for sums.
template <class Op, class T>
inline void atomic(Op, T* to, T v) {
    std::atomic_ref<T> memory(*to);
    T before = memory.load(std::memory_order_relaxed);
    // mutate: operation_commits_a_sum, atomic_operation_tries_once
    while (!memory.compare_exchange_weak(before, Op::combine(before, v), std::memory_order_relaxed)) {
    }
}
template <operation::is_sum Op, class T>
inline void atomic(Op, T* to, T v) {
    std::atomic_ref<T>(*to).fetch_add(v, std::memory_order_relaxed);  // mutate: atomic_sum_is_a_plain_one
}

}  // namespace warpagg::emulator::detail
