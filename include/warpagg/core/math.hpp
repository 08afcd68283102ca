// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiler.hpp"
#include "std_for_nvrtc.hpp"

namespace warpagg {

/// Functions that work lane by lane, so that one source of masked code runs on every model of `warp`. These
/// overloads take scalars; warp/simd_value.hpp adds those for SIMD values. The separate namespace avoids
/// conflicts with nvcc's headers, which fail to compile beside further overloads of functions such as sqrt.
namespace math {

/// Returns `yes` if the flag is set, and `no` otherwise.
template <class T>
WARPAGG_HD T select(bool mask, T yes, T no) {
    return mask ? yes : no;
}
/// Returns a b + c, rounded once.
/// @{
WARPAGG_HD float fma(float a, float b, float c) { return ::fmaf(a, b, c); }
WARPAGG_HD double fma(double a, double b, double c) { return ::fma(a, b, c); }
/// @}
/// Returns the square root, rounded to nearest. On CUDA nvcc's option -prec-sqrt decides the rounding.
/// @{
WARPAGG_HD float sqrt(float a) { return ::sqrtf(a); }
WARPAGG_HD double sqrt(double a) { return ::sqrt(a); }
/// @}
/// Returns 1 / sqrt(a). On CUDA the float version is the hardware's approximation (rsqrt.approx), within
/// 2 ulp. Precondition on CUDA: a is a positive normal number.
/// @{
WARPAGG_HD float inverse_sqrt(float a) {
#if defined(__CUDA_ARCH__)
    float r;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(a));
    return r;
#else
    return 1 / ::sqrtf(a);
#endif
}
WARPAGG_HD double inverse_sqrt(double a) { return 1 / ::sqrt(a); }
/// @}
/// Returns the absolute value.
/// @{
WARPAGG_HD float abs(float a) { return ::fabsf(a); }
WARPAGG_HD double abs(double a) { return ::fabs(a); }
/// @}
/// Returns the smaller or the larger of two values, and the first one if either is NaN.
/// @{
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T min(T a, T b) { return b < a ? b : a; }
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T max(T a, T b) { return a < b ? b : a; }
/// @}
/// Returns the infinity of float or double. NVRTC has neither a builtin nor a header for it.
template <class T>
WARPAGG_HD T infinity() {
    using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    const bits raw = sizeof(T) == 8 ? static_cast<bits>(0x7ff0000000000000ull) : bits{0x7f800000u};
    T value;
    std::memcpy(&value, &raw, sizeof value);
    return value;
}
/// Returns whether the sign bit of a float or double is set.
template <class T>
WARPAGG_HD bool is_negative(T a) {
    using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    bits raw;
    std::memcpy(&raw, &a, sizeof raw);
    return (raw >> (8 * sizeof(T) - 1)) != 0;
}

/// Returns the smaller or the larger of two values. Floats compare as in IEEE 754-2019: the result is NaN
/// if either is NaN, and -0 is smaller than +0.
/// @{
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T ieee_minimum(T a, T b) {
    if constexpr (std::is_integral_v<T>) {
        return b < a ? b : a;
    } else {
        if (a != a) return a;
        if (a == b) return is_negative(a) ? a : b;
        return a < b ? a : b;
    }
}
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T ieee_maximum(T a, T b) {
    if constexpr (std::is_integral_v<T>) {
        return a < b ? b : a;
    } else {
        if (a != a) return a;
        if (a == b) return is_negative(a) ? b : a;
        return a > b ? a : b;
    }
}
/// @}
/// Limits a to an upper or a lower bound; returns the bound if a is NaN. Cost for a float on CUDA: one
/// instruction, where `min` and `max` take two. Precondition: the bound is not NaN.
/// @{
template <class V>
WARPAGG_HD V not_above(const V& a, const V& bound) {
#if defined(__CUDA_ARCH__)
    if constexpr (std::is_same_v<V, float>)
        return ::fminf(a, bound);
    else
#endif
        return min(bound, a);
}
template <class V>
WARPAGG_HD V not_below(const V& a, const V& bound) {
#if defined(__CUDA_ARCH__)
    if constexpr (std::is_same_v<V, float>)
        return ::fmaxf(a, bound);
    else
#endif
        return max(bound, a);
}
/// @}

/// Returns 2^a. On CUDA the float version is the hardware's approximation: its relative error is at most
/// 2^-22.5 (PTX ISA, ex2.approx), and it flushes denormal results to zero.
WARPAGG_HD float exp2(float a) {
#if defined(__CUDA_ARCH__)
    float r;
    asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(a));
    return r;
#else
    return ::exp2f(a);
#endif
}
/// Returns 2^a.
WARPAGG_HD double exp2(double a) { return ::exp2(a); }
/// Returns the logarithm to base 2.
/// @{
WARPAGG_HD float log2(float a) { return ::log2f(a); }
WARPAGG_HD double log2(double a) { return ::log2(a); }
/// @}

/// Returns a / b. On CUDA the float version takes the hardware's approximate reciprocal and one Newton step;
/// its error is within 1 ulp, and a / a is 1. Precondition on CUDA: b, 1 / b and the quotient are normal.
/// @{
WARPAGG_HD float divide(float a, float b) {
#if defined(__CUDA_ARCH__)
    float inverse;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(b));
    const float quotient = a * inverse;
    return fma(fma(-quotient, b, a), inverse, quotient);
#else
    return a / b;
#endif
}
WARPAGG_HD double divide(double a, double b) { return a / b; }
/// @}

/// Converts a value to `To`, lane by lane, as static_cast does.
template <class To, class From>
requires std::is_arithmetic_v<From> WARPAGG_HD To convert(From a) { return static_cast<To>(a); }

/// Is satisfied by the 16-bit floats of CUDA and by pairs of them. They add by functions, because
/// PyTorch's compiler flags remove the operators.
/// @{
template <class T>
concept is_half = !std::is_arithmetic_v<T> && sizeof(T) == 2 && requires(T a) {
    { __hadd(a, a) } -> std::same_as<T>;
};
template <class T>
concept is_half_pair = !std::is_arithmetic_v<T> && sizeof(T) == 4 && requires(T a) {
    { __hadd2(a, a) } -> std::same_as<T>;
};
/// @}

/// Returns a + b. Integers wrap modulo 2^bits, signed ones too.
template <class T>
WARPAGG_HD T wrapping_add(const T& a, const T& b) {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 4) {
        return static_cast<T>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
    } else if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
        return static_cast<T>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
    } else if constexpr (is_half<T>) {
        return __hadd(a, b);
    } else if constexpr (is_half_pair<T>) {
        return __hadd2(a, b);
    } else {
        return a + b;
    }
}

/// Returns the number of bits that are set.
/// @{
constexpr WARPAGG_HD std::uint32_t popcount(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    if (!__builtin_is_constant_evaluated()) return static_cast<std::uint32_t>(__popc(bits));
    std::uint32_t n = 0;  // NVRTC lacks __builtin_popcount
    for (; bits != 0; bits &= bits - 1) ++n;
    return n;
#else
    return static_cast<std::uint32_t>(__builtin_popcount(bits));
#endif
}
constexpr WARPAGG_HD std::uint32_t popcount(std::uint64_t bits) {
    // mutate: upper_lanes_not_counted
    return popcount(static_cast<std::uint32_t>(bits)) + popcount(static_cast<std::uint32_t>(bits >> 32));
}
/// @}

/// Returns the index of the lowest bit that is set, or some index of a bit if no bit is set.
/// @{
WARPAGG_HD std::uint32_t countr_zero(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint32_t>(__clz(__brev(bits))) & 31u;
#else
    return static_cast<std::uint32_t>(__builtin_ctz(bits | 0x80000000u));
#endif
}
WARPAGG_HD std::uint32_t countr_zero(std::uint64_t bits) {
    const auto low = static_cast<std::uint32_t>(bits);
    // mutate: upper_lanes_not_found
    return low != 0 ? countr_zero(low) : 32 + countr_zero(static_cast<std::uint32_t>(bits >> 32));
}
/// @}

/// Returns the bits of a 32-bit unsigned integer in reverse order.
template <class V>
WARPAGG_HD V bit_reverse(const V& value) {
    V bits = value;
    const auto swap = [&](unsigned distance, unsigned lower) {
        bits = ((bits >> distance) & lower) | ((bits & lower) << distance);
    };
    swap(1, 0x55555555u);
    swap(2, 0x33333333u);
    swap(4, 0x0f0f0f0fu);
    swap(8, 0x00ff00ffu);
    swap(16, 0x0000ffffu);
    return bits;
}
#if defined(__CUDA_ARCH__)
WARPAGG_HD std::uint32_t bit_reverse(std::uint32_t bits) { return __brev(bits); }
#endif

/// Returns a lane value as a scalar. Precondition: the value is uniform.
template <class T>
requires std::is_arithmetic_v<T> WARPAGG_HD T uniform(T a) { return a; }

}  // namespace math

}  // namespace warpagg
