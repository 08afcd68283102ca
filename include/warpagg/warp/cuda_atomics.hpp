// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Atomic operations of CUDA without a result, for `cuda_warp`.

#include "../core/operation.hpp"

/// The 16-bit floats of cuda_fp16.h and cuda_bf16.h, which a program need not include.
/// @{
struct __half;
struct __half2;
struct __nv_bfloat16;
struct __nv_bfloat162;
/// @}

namespace warpagg::detail::cuda_memory {

/// The parameter type of CUDA's atomics: unsigned for 64-bit integers, T otherwise. Signed sums are
/// correct in two's complement.
template <class T>
using bits = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, unsigned long long, T>;
/// An integer of the size and sign of T; a signed one for floats.
template <class T>
using integer = std::conditional_t<
    sizeof(T) == 8,
    std::conditional_t<std::is_integral_v<T> && !std::is_signed_v<T>, unsigned long long, long long>,
    std::conditional_t<std::is_integral_v<T>, T, int>>;
/// An unsigned integer of the size of T.
template <class T>
using unsigned_integer = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;

template <class T>
inline constexpr bool is_16_bit_float = std::is_same_v<T, __half> || std::is_same_v<T, __half2> ||
                                        std::is_same_v<T, __nv_bfloat16> || std::is_same_v<T, __nv_bfloat162>;

/// Atomic operations that are visible to the threads of a scope. CUDA's functions become RED
/// instructions, because their results are not used.
template <class Scope>
struct scope_atomics;

/// @def WARPAGG_CUDA_SCOPE
/// Defines `scope_atomics<scope::TAG>`. SUFFIX is the suffix of CUDA's functions, NAME the scope's name in
/// PTX.
#define WARPAGG_CUDA_SCOPE(TAG, SUFFIX, NAME)                                                           \
    template <>                                                                                         \
    struct scope_atomics<scope::TAG> {                                                                  \
        template <class T>                                                                              \
        static __device__ __forceinline__ void add(T* to, T v) {                                        \
            atomicAdd##SUFFIX(to, v);                                                                   \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ void smaller(T* to, T v) {                                    \
            atomicMin##SUFFIX(to, v);                                                                   \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ void larger(T* to, T v) {                                     \
            atomicMax##SUFFIX(to, v);                                                                   \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ void bit_and(T* to, T v) {                                    \
            atomicAnd##SUFFIX(to, v);                                                                   \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ void bit_or(T* to, T v) {                                     \
            atomicOr##SUFFIX(to, v);                                                                    \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ void bit_xor(T* to, T v) {                                    \
            atomicXor##SUFFIX(to, v);                                                                   \
        }                                                                                               \
        template <class T>                                                                              \
        static __device__ __forceinline__ T exchange_if(T* to, T expected, T v) {                       \
            return atomicCAS##SUFFIX(to, expected, v);                                                  \
        }                                                                                               \
        static __device__ __forceinline__ void add_half(std::size_t to, unsigned short v) {             \
            asm volatile("red.relaxed." NAME ".global.add.noftz.f16 [%0], %1;" ::"l"(to), "h"(v)        \
                         : "memory");                                                                   \
        }                                                                                               \
        static __device__ __forceinline__ void add_half2(std::size_t to, unsigned v) {                  \
            asm volatile("red.relaxed." NAME ".global.add.noftz.f16x2 [%0], %1;" ::"l"(to), "r"(v)      \
                         : "memory");                                                                   \
        }                                                                                               \
        static __device__ __forceinline__ void add_bfloat(std::size_t to, unsigned short v) {           \
            asm volatile("red.relaxed." NAME ".global.add.noftz.bf16 [%0], %1;" ::"l"(to), "h"(v)       \
                         : "memory");                                                                   \
        }                                                                                               \
        static __device__ __forceinline__ void add_bfloat2(std::size_t to, unsigned v) {                \
            asm volatile("red.relaxed." NAME ".global.add.noftz.bf16x2 [%0], %1;" ::"l"(to), "r"(v)     \
                         : "memory");                                                                   \
        }                                                                                               \
        static __device__ __forceinline__ void add_2(std::size_t to, const float* v) {                  \
            asm volatile("red.relaxed." NAME ".global.add.v2.f32 [%0], {%1, %2};" ::"l"(to), "f"(v[0]), \
                         "f"(v[1])                                                                      \
                         : "memory");                                                                   \
        }                                                                                               \
        static __device__ __forceinline__ void add_4(std::size_t to, const float* v) {                  \
            asm volatile("red.relaxed." NAME ".global.add.v4.f32 [%0], {%1, %2, %3, %4};" ::"l"(to),    \
                         "f"(v[0]), "f"(v[1]), "f"(v[2]), "f"(v[3])                                     \
                         : "memory");                                                                   \
        }                                                                                               \
    }
WARPAGG_CUDA_SCOPE(block, _block, "cta");
WARPAGG_CUDA_SCOPE(device, , "gpu");
WARPAGG_CUDA_SCOPE(system, _system, "sys");
#undef WARPAGG_CUDA_SCOPE

/// Adds 16-bit floats. In global memory this is one RED instruction, where CUDA's `atomicAdd` is an
/// atomic with a result and a loop. Elsewhere, and for bfloat16 below compute capability 9.0, it is
/// CUDA's `atomicAdd`.
template <class Scope, class T>
__device__ __forceinline__ void add_16_bit_floats(T* to, T v) {
    [[maybe_unused]] const std::size_t address = __cvta_generic_to_global(to);
    std::conditional_t<sizeof(T) == 4, unsigned, unsigned short> raw;
    std::memcpy(&raw, &v, sizeof raw);
    if (__isGlobal(to)) {
        if constexpr (std::is_same_v<T, __half>) {
            scope_atomics<Scope>::add_half(address, raw);
            return;
        } else if constexpr (std::is_same_v<T, __half2>) {
            scope_atomics<Scope>::add_half2(address, raw);
            return;
        }
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
        if constexpr (std::is_same_v<T, __nv_bfloat16>) {
            scope_atomics<Scope>::add_bfloat(address, raw);
            return;
        } else if constexpr (std::is_same_v<T, __nv_bfloat162>) {
            scope_atomics<Scope>::add_bfloat2(address, raw);
            return;
        }
#endif
    }
    atomicAdd(to, v);
}

/// Sets a float in memory to the smaller or the larger of it and v. Floats of one sign have the order
/// of their bits as integers, and negative floats have the opposite order. NaN has bits that lose
/// against no other value. Precondition: memory holds no NaN but those from this function.
/// @{
template <class Scope, class T>
__device__ __forceinline__ void smaller_float(T* to, T v) {
    using sign = integer<T>;
    using raw = unsigned_integer<T>;
    raw word;
    std::memcpy(&word, &v, sizeof word);
    if (v != v) word = static_cast<raw>(~raw{0});
    if (static_cast<sign>(word) >= 0) {
        scope_atomics<Scope>::smaller(reinterpret_cast<sign*>(to), static_cast<sign>(word));
    } else {
        scope_atomics<Scope>::larger(reinterpret_cast<raw*>(to), word);
    }
}
template <class Scope, class T>
__device__ __forceinline__ void larger_float(T* to, T v) {
    using sign = integer<T>;
    using raw = unsigned_integer<T>;
    raw word;
    std::memcpy(&word, &v, sizeof word);
    if (v != v) word = static_cast<raw>(~raw{0}) >> 1;
    if (static_cast<sign>(word) >= 0) {
        scope_atomics<Scope>::larger(reinterpret_cast<sign*>(to), static_cast<sign>(word));
    } else {
        scope_atomics<Scope>::smaller(reinterpret_cast<raw*>(to), word);
    }
}
/// @}

/// Sets `*to = Op::combine(*to, v)`, relaxed. The overload is selected by the operation, which may be
/// `scoped`.
/// @{
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::sum, T* to, T v) {
    if constexpr (is_16_bit_float<T>) {
        add_16_bit_floats<Scope>(to, v);
    } else {
        scope_atomics<Scope>::add(reinterpret_cast<bits<T>*>(to), static_cast<bits<T>>(v));
    }
}
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::minimum, T* to, T v) {
    if constexpr (std::is_integral_v<T>) {
        scope_atomics<Scope>::smaller(reinterpret_cast<integer<T>*>(to), static_cast<integer<T>>(v));
    } else {
        smaller_float<Scope>(to, v);
    }
}
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::maximum, T* to, T v) {
    if constexpr (std::is_integral_v<T>) {
        scope_atomics<Scope>::larger(reinterpret_cast<integer<T>*>(to), static_cast<integer<T>>(v));
    } else {
        larger_float<Scope>(to, v);
    }
}
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::bit_and, T* to, T v) {
    scope_atomics<Scope>::bit_and(reinterpret_cast<bits<T>*>(to), static_cast<bits<T>>(v));
}
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::bit_or, T* to, T v) {
    scope_atomics<Scope>::bit_or(reinterpret_cast<bits<T>*>(to), static_cast<bits<T>>(v));
}
template <class Scope, class T>
__device__ __forceinline__ void atomic(operation::bit_xor, T* to, T v) {
    scope_atomics<Scope>::bit_xor(reinterpret_cast<bits<T>*>(to), static_cast<bits<T>>(v));
}
template <class Scope, class Op, class T>
requires Op::by_exchange __device__ __forceinline__ void atomic(Op, T* to, T v) {
    auto* word = reinterpret_cast<unsigned long long*>(to);
    for (unsigned long long before = *static_cast<volatile unsigned long long*>(word);;) {
        const unsigned long long after = Op::combine(static_cast<T>(before), v);
        if (after == before) return;
        const unsigned long long seen = scope_atomics<Scope>::exchange_if(word, before, after);
        if (seen == before) return;
        before = seen;
    }
}
/// @}

}  // namespace warpagg::detail::cuda_memory
