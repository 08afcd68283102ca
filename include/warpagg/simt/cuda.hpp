// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "warp.hpp"

namespace warpagg::cuda {

/// The warp that the calling thread belongs to. Empty; every operation is one instruction or a few.
///
/// Precondition: all 32 lanes of the warp are launched and call each operation together. A lane takes part or
/// not by its `active` argument; no mask is taken from `__activemask()`, so results do not depend on how the
/// compiler converges lanes.
struct warp {
    static constexpr unsigned size = 32;
    template <class T>
    using value = T;

    __device__ __forceinline__ unsigned lane() const {
        unsigned id;
        asm("mov.u32 %0, %%laneid;" : "=r"(id));
        return id;
    }
    __device__ __forceinline__ std::uint32_t ballot(bool p) const { return __ballot_sync(all, p); }
    __device__ __forceinline__ bool any(bool p) const { return __any_sync(all, p) != 0; }

    template <class T>
    __device__ __forceinline__ T shfl(T v, unsigned from) const {
        return __shfl_sync(all, v, static_cast<int>(from));
    }
    template <class T>
    __device__ __forceinline__ T shfl_down(T v, unsigned distance) const {
        return __shfl_down_sync(all, v, distance);
    }
    template <class T>
    __device__ __forceinline__ T shfl_xor(T v, unsigned distance) const {
        return __shfl_xor_sync(all, v, static_cast<int>(distance));
    }

    template <class T>
    __device__ __forceinline__ T load(const T* from, unsigned index, bool active) const {
        return active ? from[index] : T{};
    }
    template <class T>
    __device__ __forceinline__ void store(T* to, unsigned index, T v, bool active) const {
        if (active) to[index] = v;
    }
    template <class T>
    __device__ __forceinline__ T load_row(const T* from, std::ptrdiff_t first, bool active) const {
        return active ? from[first + static_cast<std::ptrdiff_t>(lane())] : T{};
    }
    template <class T>
    __device__ __forceinline__ void store_row(T* to, std::ptrdiff_t first, T v, bool active) const {
        if (active) to[first + static_cast<std::ptrdiff_t>(lane())] = v;
    }
    /// Compiles to RED, which returns nothing. `T`: float, double (sm_60), int, unsigned.
    template <class Dst, class T>
    __device__ __forceinline__ void atomic_add(Dst dst, unsigned index, T v, bool active) const {
        if (active) atomicAdd(dst(index), v);
    }

  private:
    static constexpr unsigned all = 0xffffffffu;
};

static_assert(warpagg::warp<warp>);

}  // namespace warpagg::cuda
