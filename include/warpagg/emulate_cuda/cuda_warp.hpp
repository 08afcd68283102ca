// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../warp/concept.hpp"
#include "runtime_interface.hpp"

namespace warpagg {

/// The class of this name in emulated kernels: the warp of the calling thread, with the operations of the
/// concept `warp`. The emulator diagnoses violations of their rules, as for `emulator::checked`.
class cuda_warp {
  public:
    /// The member of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = 32;
    template <class T>
    using value = T;

    unsigned lane() const { return emulator::detail::runtime::lane(); }

    std::uint32_t ballot(bool p, call_site at = call_site::here("ballot")) const {
        return emulator::detail::runtime::vote({}, p, at);
    }
    bool any(bool p, call_site at = call_site::here("any")) const {
        return emulator::detail::runtime::vote({}, p, at) != 0;
    }
    template <class Key>
    std::uint32_t match(Key key, call_site at = call_site::here("match")) const {
        return emulator::detail::runtime::match({}, key, at);
    }
    template <class T>
    T shfl(T v, unsigned from, call_site at = call_site::here("shfl")) const {
        return emulator::detail::runtime::exchange({}, v, from % size, at);
    }
    template <class T>
    T shfl_down(T v, unsigned distance, call_site at = call_site::here("shfl_down")) const {
        return emulator::detail::runtime::exchange({}, v,
                                                   distance < size - lane() ? lane() + distance : lane(), at);
    }
    template <class T>
    T shfl_xor(T v, unsigned distance, call_site at = call_site::here("shfl_xor")) const {
        return emulator::detail::runtime::exchange({}, v, (lane() ^ distance) % size, at);
    }

    template <class T>
    T load(const T* from, unsigned index, bool active, call_site at = call_site::here("load")) const {
        return active ? emulator::detail::runtime::read(from + index, at) : T{};
    }
    template <class T, int N>
    void load_packed(const T* from, unsigned index, T (&v)[N], bool active,
                     call_site at = call_site::here("load_packed")) const {
        for (unsigned k = 0; k < N; ++k) v[k] = load(from, index + k, active, at);
    }
    template <class T>
    void store(T* to, unsigned index, T v, bool active, call_site at = call_site::here("store")) const {
        if (active) emulator::detail::runtime::write(to + index, v, at);
    }
    template <class T, int N>
    void store_packed(T* to, unsigned index, const T (&v)[N], bool active,
                      call_site at = call_site::here("store_packed")) const {
        for (unsigned k = 0; k < N; ++k) store(to, index + k, v[k], active, at);
    }
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first, bool active,
               call_site at = call_site::here("load_row")) const {
        return active ? emulator::detail::runtime::read(from + first + lane(), at) : T{};
    }
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first, call_site at = call_site::here("load_row")) const {
        return emulator::detail::runtime::read(from + first + lane(), at);
    }
    template <class T>
    void store_row(T* to, std::ptrdiff_t first, T v, bool active,
                   call_site at = call_site::here("store_row")) const {
        if (active) emulator::detail::runtime::write(to + first + lane(), v, at);
    }
    void sync(call_site at = call_site::here("sync")) const { emulator::detail::runtime::sync({}, at); }
    template <class Op, class Dst, class Index, class T>
    void atomic(Op, Dst dst, Index index, T v, bool active, call_site at = call_site::here("atomic")) const {
        emulator::detail::runtime::vote({}, active, at);
        if (active)
            emulator::detail::runtime::update(
                dst(index), v, [](T a, T b) { return Op::combine(a, b); }, at);
    }
    /// @}

    /// Informs or checks the emulator. The library calls this, not kernels.
    /// @{
    void require_uniform(const void* destination, call_site at = call_site::here("require_uniform")) const {
        emulator::detail::runtime::require_uniform(destination, at);
    }
    void require_busy(bool busy, call_site at = call_site::here("require_busy")) const {
        emulator::detail::runtime::require_busy(busy, at);
    }
    void enter(const call_site& at) const { emulator::detail::runtime::enter(at); }
    void leave() const { emulator::detail::runtime::leave(); }
    void enter_loop(const call_site& at) const { emulator::detail::runtime::enter_loop(at); }
    void next_iteration() const { emulator::detail::runtime::next_iteration(); }
    void leave_loop() const { emulator::detail::runtime::leave_loop(); }
    /// @}
};

static_assert(warp<cuda_warp>);

}  // namespace warpagg
