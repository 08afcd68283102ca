// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace warpagg::emulator::detail {

/// What the emulators' atomics do to memory: warps may run on several threads.
template <class T>
inline void atomic_add(T* to, T v) {
    std::atomic_ref<T>(*to).fetch_add(v, std::memory_order_relaxed);
}

}  // namespace warpagg::emulator::detail
