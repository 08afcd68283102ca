// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/atomic_memory.hpp"
#include "concept.hpp"

/// Models of the concept `warp` for a CPU.
namespace warpagg::emulator {

/// A model of `warp` with one lane, the reference for the results of other models. Several threads
/// may run warps that commit to the same memory.
struct serial {
    /// The member of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = 1;
    template <class T>
    using value = T;

    unsigned lane() const { return 0; }
    std::uint32_t ballot(bool p) const { return p ? 1u : 0u; }
    bool any(bool p) const { return p; }

    template <class Key>
    std::uint32_t match(Key) const {
        return 1u;
    }

    template <class T>
    T shfl(T v, unsigned) const {
        return v;
    }
    template <class T>
    T shfl_down(T v, unsigned) const {
        return v;
    }
    template <class T>
    T shfl_xor(T v, unsigned) const {
        return v;
    }

    template <class T>
    T load(const T* from, unsigned index, bool active) const {
        return active ? from[index] : T{};
    }
    template <class T, int N>
    void load_packed(const T* from, unsigned index, T (&v)[N], bool active) const {
        for (unsigned k = 0; k < N; ++k) v[k] = load(from, index + k, active);
    }
    template <class T>
    void store(T* to, unsigned index, T v, bool active) const {
        if (active) to[index] = v;
    }
    template <class T, int N>
    void store_packed(T* to, unsigned index, const T (&v)[N], bool active) const {
        for (unsigned k = 0; k < N; ++k) store(to, index + k, v[k], active);
    }
    void sync() const {}
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first, bool active) const {
        return active ? from[first] : T{};
    }
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first) const {
        return from[first];
    }
    template <class T>
    void store_row(T* to, std::ptrdiff_t first, T v, bool active) const {
        if (active) to[first] = v;
    }
    template <class Op, class Dst, class Index, class T>
    void atomic(Op op, Dst dst, Index index, T v, bool active) const {
        if (active) detail::atomic(op, dst(index), v);
    }
    /// @}
};

static_assert(warpagg::warp<serial>);

}  // namespace warpagg::emulator
