// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/operation.hpp"
#include "concept.hpp"
#include "cuda_atomics.hpp"

namespace warpagg {

namespace detail::cuda_memory {

/// Four values. If they have 32 bits each, one instruction loads or stores all four.
template <class T>
struct alignas(16) four {
    T at[4];
};

}  // namespace detail::cuda_memory

/// The model of the concept `warp` for a GPU: the warp of the calling thread. The object is empty, and
/// each operation is one or a few instructions.
///
/// Precondition: all 32 lanes of the warp are launched and call each operation together. The argument
/// `active` tells whether a lane is active. No operation uses `__activemask()`, so results do not
/// depend on how the compiler converges lanes.
struct cuda_warp {
    /// The member of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = 32;
    template <class T>
    using value = T;

    __device__ __forceinline__ unsigned lane() const {
        unsigned id;
        asm("mov.u32 %0, %%laneid;" : "=r"(id));
        return id;
    }
    /// Returns whether `lane() & Distance` is not zero. Cost: one AND; compilers add a shift to the
    /// same expression in C++.
    template <unsigned Distance>
    __device__ __forceinline__ bool is_upper() const {
        unsigned bit;
        asm("and.b32 %0, %1, %2;" : "=r"(bit) : "r"(lane()), "n"(Distance));
        return bit != 0;
    }
    // mutate: cuda_mask_from_activemask
    __device__ __forceinline__ std::uint32_t ballot(bool p) const { return __ballot_sync(all, p); }
    __device__ __forceinline__ bool any(bool p) const { return __any_sync(all, p) != 0; }

    template <class T>
    __device__ __forceinline__ T shfl(T v, unsigned from) const {
        return __shfl_sync(all, v, static_cast<int>(from));
    }
    template <class T>
    __device__ __forceinline__ T shfl_down(T v, unsigned distance) const {
        return __shfl_down_sync(all, v, distance);  // mutate: cuda_shuffles_up
    }
    template <class T>
    __device__ __forceinline__ T shfl_xor(T v, unsigned distance) const {
        return __shfl_xor_sync(all, v, static_cast<int>(distance));
    }

    template <class Key>
    __device__ __forceinline__ std::uint32_t match(Key key) const {
        if constexpr (sizeof(Key) == 8) {
            return __match_any_sync(all, static_cast<unsigned long long>(key));
        } else {
            return __match_any_sync(all, static_cast<unsigned>(key));
        }
    }

    template <class T>
    __device__ __forceinline__ T load(const T* from, unsigned index, bool active) const {
        return active ? from[index] : T{};
    }
    template <class T, int N>
    __device__ __forceinline__ void load_packed(const T* from, unsigned index, T (&v)[N], bool active) const {
        static_assert(N % 4 == 0);
        using four = detail::cuda_memory::four<T>;
#pragma unroll
        for (int i = 0; i < N; i += 4) {
            four f{};
            if (active) f = *reinterpret_cast<const four*>(from + index + i);
#pragma unroll
            for (int k = 0; k < 4; ++k) v[i + k] = f.at[k];
        }
    }
    template <class T, int N>
    __device__ __forceinline__ void store_packed(T* to, unsigned index, const T (&v)[N], bool active) const {
        static_assert(N % 4 == 0);
        using four = detail::cuda_memory::four<T>;
        if (!active) return;
#pragma unroll
        for (int i = 0; i < N; i += 4)
            *reinterpret_cast<four*>(to + index + i) = {{v[i], v[i + 1], v[i + 2], v[i + 3]}};
    }
    __device__ __forceinline__ void sync() const { __syncwarp(); }
    template <class T>
    __device__ __forceinline__ void store(T* to, unsigned index, T v, bool active) const {
        if (active) to[index] = v;  // mutate: cuda_inactive_lanes_store
    }
    template <class T>
    __device__ __forceinline__ T load_row(const T* from, std::ptrdiff_t first, bool active) const {
        return active ? from[first + static_cast<std::ptrdiff_t>(lane())] : T{};
    }
    template <class T>
    __device__ __forceinline__ T load_row(const T* from, std::ptrdiff_t first) const {
        return from[first + static_cast<std::ptrdiff_t>(lane())];
    }
    template <class T>
    __device__ __forceinline__ void store_row(T* to, std::ptrdiff_t first, T v, bool active) const {
        if (active) to[first + static_cast<std::ptrdiff_t>(lane())] = v;
    }
    /// @}

    /// Sets `*dst(index) = Op::combine(*dst(index), v)` in active lanes, relaxed, in the scope of the
    /// operation. Sums take float, double, integers of 32 and 64 bits, 16-bit floats and pairs of
    /// them; minimum and maximum take float, double and integers of 32 and 64 bits; the other
    /// operations take integers of 32 and 64 bits. Cost: one RED instruction, an atomic without a
    /// result; operations on words, and pairs of bfloat16 below compute capability 9.0, take a
    /// compare-and-swap loop.
    template <class Op, class Dst, class Index, class T>
    __device__ __forceinline__ void atomic(Op op, Dst dst, Index index, T v, bool active) const {
        // mutate: cuda_inactive_lanes_commit
        if (active) detail::cuda_memory::atomic<operation::scope_of<Op>>(op, dst(index), v);
    }
    /// Returns whether `atomic_add_packed<K>` may add to to[0..K): the address is in global memory and
    /// aligned to K floats, and the compute capability is 9.0 or more.
    template <unsigned K>
    __device__ __forceinline__ bool packs(const float* to) const {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
        return reinterpret_cast<std::uintptr_t>(to) % (K * sizeof(float)) == 0 && __isGlobal(to);
#else
        return false;
#endif
    }
    /// Adds v[0..K) to to[0..K) in active lanes. Cost: one RED instruction. Precondition:
    /// `packs<K>(to)`, or K = 1.
    template <unsigned K, class Op>
    __device__ __forceinline__ void atomic_add_packed(Op op, float* to, const float* v, bool active) const {
        using memory = detail::cuda_memory::scope_atomics<operation::scope_of<Op>>;
        if (!active) return;
        if constexpr (K == 1) {
            detail::cuda_memory::atomic<operation::scope_of<Op>>(op, to, v[0]);
        } else {
            // Older devices never get here, but without optimization this is compiled for them, too.
#if !defined(__CUDA_ARCH__) || __CUDA_ARCH__ >= 900
            if constexpr (K == 4)
                memory::add_4(__cvta_generic_to_global(to), v);
            else
                memory::add_2(__cvta_generic_to_global(to), v);
#endif
        }
    }

#if !defined(__CUDA_ARCH__) || __CUDA_ARCH__ >= 800  // on older devices `reduce::redux` uses butterfly
    /// Returns v combined over the warp, in every lane. Cost: one instruction, `redux.sync`.
    /// @{
    __device__ __forceinline__ int redux(operation::sum, int v) const { return __reduce_add_sync(all, v); }
    __device__ __forceinline__ int redux(operation::minimum, int v) const {
        return __reduce_min_sync(all, v);
    }
    __device__ __forceinline__ int redux(operation::maximum, int v) const {
        return __reduce_max_sync(all, v);
    }
    __device__ __forceinline__ unsigned redux(operation::sum, unsigned v) const {
        return __reduce_add_sync(all, v);
    }
    __device__ __forceinline__ unsigned redux(operation::minimum, unsigned v) const {
        return __reduce_min_sync(all, v);
    }
    __device__ __forceinline__ unsigned redux(operation::maximum, unsigned v) const {
        return __reduce_max_sync(all, v);
    }
    template <class T>
    __device__ __forceinline__ T redux(operation::bit_and, T v) const {
        return static_cast<T>(__reduce_and_sync(all, static_cast<unsigned>(v)));
    }
    template <class T>
    __device__ __forceinline__ T redux(operation::bit_or, T v) const {
        return static_cast<T>(__reduce_or_sync(all, static_cast<unsigned>(v)));
    }
    template <class T>
    __device__ __forceinline__ T redux(operation::bit_xor, T v) const {
        return static_cast<T>(__reduce_xor_sync(all, static_cast<unsigned>(v)));
    }
    /// @}
#endif

    /// Returns the flag, but hides its value from the compiler. Otherwise the compiler splits a loop in
    /// which the flag is constant. A warp whose lanes differ then runs both halves and waits at every
    /// shuffle.
    __device__ __forceinline__ bool opaque(bool flag) const {
        unsigned known = flag;
        asm volatile("" : "+r"(known));
        return known != 0;
    }

#if defined(WARPAGG_CHECKS)
    /// Checks a rule, in programs compiled with WARPAGG_CHECKS. A kernel that violates it prints a
    /// message and traps.
    __device__ void require_uniform(const void* destination) const {
        int same = 0;
        __match_all_sync(all, reinterpret_cast<unsigned long long>(destination), &same);
        if (same == 0) stop("the destination is not the same in every lane");
    }
    __device__ void require_busy(bool active) const {
        if (!any(active)) stop("assume_busy, but no lane is active");
    }
#endif

  private:
#if defined(WARPAGG_CHECKS)
    __device__ void stop(const char* sentence) const {
        if (lane() == 0) printf("warpagg: block %u, thread %u: %s\n", blockIdx.x, threadIdx.x, sentence);
        __syncwarp();  // lets lane 0 print before any lane traps
        __trap();
    }
#endif
    static constexpr unsigned all = 0xffffffffu;
};

static_assert(warp<cuda_warp>);

#if defined(WARPAGG_OLD_CUDA_NAME)
/// A deprecated name of `cuda_warp`. It requires the macro WARPAGG_OLD_CUDA_NAME, because with `using
/// namespace warpagg` this namespace makes `cuda::` ambiguous: the CUDA toolkit also has a namespace
/// `cuda`.
namespace cuda {
using warp [[deprecated("use warpagg::cuda_warp")]] = cuda_warp;
}  // namespace cuda
#endif

}  // namespace warpagg
