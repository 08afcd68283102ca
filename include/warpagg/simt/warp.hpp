// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// The `warp` concept: what warpagg asks of a machine that runs lanes in step.
///
/// A model `W` names the type that holds one `T` per lane, `value_t<W, T>`: plain `T` where the hardware (or
/// the emulator) runs the lanes itself, a SIMD vector where one thread of control holds them all. Code that
/// uses `select` instead of `if` on lane values runs on every model.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(__CUDACC__)
#define WARPAGG_HD __host__ __device__ __forceinline__
// A host-device template that calls a device-only member is no fault until somebody calls it from the host.
#define WARPAGG_EXEC_CHECK_DISABLE _Pragma("nv_exec_check_disable")
#else
#define WARPAGG_HD inline __attribute__((always_inline))
#define WARPAGG_EXEC_CHECK_DISABLE
#endif

// A short loop over registers: rolled up, its arrays would live in memory.
#if defined(__CUDA_ARCH__) || defined(__clang__)
#define WARPAGG_UNROLL _Pragma("unroll")
#elif defined(__CUDACC__)  // nvcc's pass over host code, whose compiler does not know the pragma
#define WARPAGG_UNROLL
#else
#define WARPAGG_UNROLL _Pragma("GCC unroll 64")
#endif

namespace warpagg {

/// The type that holds one `T` per lane of the warp model `W`.
template <class W, class T>
using value_t = typename W::template value<T>;

/// One flag per lane.
template <class W>
using mask_t = value_t<W, bool>;

/// A warp: `W::size` lanes, a power of two up to 32. All lanes call each operation together.
///
/// | operation | meaning |
/// | --- | --- |
/// | `lane()` | each lane's number, from 0 |
/// | `ballot(p)` | bit i is lane i's p; the same in every lane |
/// | `any(p)` | some lane's p; the same in every lane |
/// | `shfl(v, i)` | lane i's v, `i` the same in every lane |
/// | `shfl_down(v, d)` | v of the lane d further; lanes past the end keep their own |
/// | `shfl_xor(v, d)` | v of the lane whose number differs in the bits of d |
/// | `load(p, i, active)` | `p[i]` per active lane; inactive lanes read nothing and get T{}; i < 2^31 |
/// | `store(p, i, v, active)` | `p[i] = v` per active lane |
/// | `load_row(p, i, active)` | `p[i + lane]` per active lane; `i` is uniform and may be negative |
/// | `store_row(p, i, v, active)` | `p[i + lane] = v` per active lane |
/// | `atomic_add(dst, i, v, active)` | per active lane, `*dst(i) += v`, atomically, relaxed |
template <class W>
concept warp = requires(const W& w, value_t<W, float> v, value_t<W, unsigned> i, mask_t<W> p, float* m,
                        float* (*dst)(unsigned)) {
    { W::size } -> std::convertible_to<unsigned>;
    { w.lane() } -> std::same_as<value_t<W, unsigned>>;
    { w.ballot(p) } -> std::same_as<std::uint32_t>;
    { w.any(p) } -> std::same_as<bool>;
    { w.shfl(v, 0u) } -> std::same_as<value_t<W, float>>;
    { w.shfl_down(v, 1u) } -> std::same_as<value_t<W, float>>;
    { w.shfl_xor(v, 1u) } -> std::same_as<value_t<W, float>>;
    { w.load(m, i, p) } -> std::same_as<value_t<W, float>>;
    w.store(m, i, v, p);
    { w.load_row(m, std::ptrdiff_t{}, p) } -> std::same_as<value_t<W, float>>;
    w.store_row(m, std::ptrdiff_t{}, v, p);
    w.atomic_add(dst, i, v, p);
};

/// Lane-wise operations, so that masked code reads the same on every model: here for models whose lane values
/// are scalars. A namespace of its own, since nvcc's own headers stumble over other overloads of sqrt and the
/// like.
namespace math {

template <class T>
WARPAGG_HD T select(bool mask, T yes, T no) {
    return mask ? yes : no;
}
WARPAGG_HD float fma(float a, float b, float c) { return ::fmaf(a, b, c); }
WARPAGG_HD double fma(double a, double b, double c) { return ::fma(a, b, c); }
WARPAGG_HD float sqrt(float a) { return ::sqrtf(a); }
WARPAGG_HD double sqrt(double a) { return ::sqrt(a); }
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T min(T a, T b) { return b < a ? b : a; }
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T max(T a, T b) { return a < b ? b : a; }

/// 2^a. On CUDA the float version is the hardware's approximation: 2 ulp, denormal results flushed to zero.
WARPAGG_HD float exp2(float a) {
#if defined(__CUDA_ARCH__)
    float r;
    asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(a));
    return r;
#else
    return ::exp2f(a);
#endif
}
WARPAGG_HD double exp2(double a) { return ::exp2(a); }

/// Lane-wise conversion.
template <class To, class From>
requires std::is_arithmetic_v<From> WARPAGG_HD To convert(From a) { return static_cast<To>(a); }

}  // namespace math

namespace detail {

WARPAGG_HD unsigned popcount(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return static_cast<unsigned>(__popc(bits));
#else
    return static_cast<unsigned>(__builtin_popcount(bits));
#endif
}

/// The T of a `value_t<W, T>`.
template <class V>
struct scalar_of {
    using type = V;
};
template <class V>
requires requires { typename V::scalar; }
struct scalar_of<V> {
    using type = typename V::scalar;
};

}  // namespace detail
}  // namespace warpagg
