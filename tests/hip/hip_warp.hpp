// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

/// A model of `warp` for AMD's GPUs with 64 lanes, which shows that such a model takes one file. The tests
/// compile it with clang. It has never run on a GPU.
struct hip_warp {
    static constexpr unsigned size = 64;
    template <class T>
    using value = T;

    __device__ unsigned lane() const {
        return __builtin_amdgcn_mbcnt_hi(~0u, __builtin_amdgcn_mbcnt_lo(~0u, 0u));
    }
    __device__ std::uint64_t ballot(bool p) const {
        constexpr int not_equal = 33;  // ICMP_NE of LLVM
        return __builtin_amdgcn_uicmp(p ? 1u : 0u, 0u, not_equal);
    }
    __device__ bool any(bool p) const { return ballot(p) != 0; }

    template <class T>
    __device__ T shfl(T v, unsigned from) const {
        int words[(sizeof v + 3) / 4] = {};
        __builtin_memcpy(words, &v, sizeof v);
        for (int& word : words) word = __builtin_amdgcn_ds_bpermute(static_cast<int>(from % size * 4), word);
        __builtin_memcpy(&v, words, sizeof v);
        return v;
    }
    template <class T>
    __device__ T shfl_down(T v, unsigned distance) const {
        return shfl(v, lane() + distance < size ? lane() + distance : lane());
    }
    template <class T>
    __device__ T shfl_xor(T v, unsigned distance) const {
        return shfl(v, lane() ^ distance);
    }
    /// Takes one round per different key, because AMD's GPUs have no instruction for it.
    template <class Key>
    __device__ std::uint64_t match(Key key) const {
        std::uint64_t equal = 0;
        for (std::uint64_t left = ~std::uint64_t{0}; left != 0;) {
            const bool has_it = key == shfl(key, warpagg::math::countr_zero(left));
            const std::uint64_t lanes = ballot(has_it);
            if (has_it) equal = lanes;
            left &= ~lanes;
        }
        return equal;
    }

    template <class T>
    __device__ T load(const T* from, unsigned index, bool active) const {
        return active ? from[index] : T{};
    }
    template <class T, int N>
    __device__ void load_packed(const T* from, unsigned index, T (&v)[N], bool active) const {
        for (unsigned k = 0; k < N; ++k) v[k] = load(from, index + k, active);
    }
    template <class T>
    __device__ void store(T* to, unsigned index, T v, bool active) const {
        if (active) to[index] = v;
    }
    template <class T, int N>
    __device__ void store_packed(T* to, unsigned index, const T (&v)[N], bool active) const {
        for (unsigned k = 0; k < N; ++k) store(to, index + k, v[k], active);
    }
    template <class T>
    __device__ T load_row(const T* from, std::ptrdiff_t first) const {
        return from[first + static_cast<std::ptrdiff_t>(lane())];
    }
    template <class T>
    __device__ T load_row(const T* from, std::ptrdiff_t first, bool active) const {
        return active ? load_row(from, first) : T{};
    }
    template <class T>
    __device__ void store_row(T* to, std::ptrdiff_t first, T v, bool active) const {
        if (active) to[first + static_cast<std::ptrdiff_t>(lane())] = v;
    }
    __device__ void sync() const {
        __builtin_amdgcn_fence(__ATOMIC_ACQ_REL, "wavefront");
        __builtin_amdgcn_wave_barrier();
    }

    template <class Op, class Dst, class Index, class T>
    __device__ void atomic(Op, Dst dst, Index index, T v, bool active) const {
        if (!active) return;
        T* const to = dst(index);
        if constexpr (warpagg::operation::is_sum<Op>) {
            __hip_atomic_fetch_add(to, v, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT);
        } else {
            T before = __hip_atomic_load(to, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT);
            while (!__hip_atomic_compare_exchange_weak(to, &before, Op::combine(before, v), __ATOMIC_RELAXED,
                                                       __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT)) {
            }
        }
    }
};

static_assert(warpagg::warp<hip_warp>);
