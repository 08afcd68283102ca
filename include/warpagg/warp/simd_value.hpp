// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// `simd_value<T, L>`, which holds L values of T in SIMD registers. It uses the vector extension of
/// GCC and Clang in chunks of 256 bits, because compilers do not vectorize plain arrays reliably.
/// nvcc rejects vector types in host-device templates, so include this header in `.cpp` files only.

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "concept.hpp"

namespace warpagg {

namespace detail {

constexpr int chunk_bytes = 32;

/// The type of a stored value. A flag is stored as 32 bits, all ones or all zeros, because comparisons
/// of 32-bit vectors return this form.
template <class T>
struct element {
    using type = T;
};
template <>
struct element<bool> {
    using type = std::int32_t;
};
template <class T>
using element_t = typename element<T>::type;

template <class T>
struct chunk {
    typedef element_t<T> type __attribute__((vector_size(chunk_bytes)));
};
template <class T>
using chunk_t = typename chunk<T>::type;

}  // namespace detail

/// A SIMD value: L values of T, one per lane. T is `float`, `double`, `bool` or an integer of 32 or
/// 64 bits. It has the arithmetic and bitwise operators of T, and comparisons that return
/// `simd_value<bool, L>`. All of them work lane by lane. A plain T converts to the same value in
/// every lane.
template <class T, int L>
struct simd_value {
    /// The type of a lane's value, and the layout of lanes in chunks of 256 bits.
    /// @{
    using scalar = T;
    using element = detail::element_t<T>;
    using chunk = detail::chunk_t<T>;
    static constexpr int width = detail::chunk_bytes / static_cast<int>(sizeof(element));  // lanes per chunk
    static constexpr int chunks = L / width;
    static constexpr bool has_order = !std::is_same_v<T, bool>;
    static_assert(L % width == 0);

    chunk part[chunks];
    /// @}

    /// Leaves the values uninitialized.
    simd_value() = default;
    /// Sets every lane to `value`.
    WARPAGG_HD simd_value(T value) {  // NOLINT: implicit, so that uniform values mix with lane values
        element e;
        if constexpr (std::is_same_v<T, bool>) {
            e = value ? -1 : 0;
        } else {
            e = value;
        }
        WARPAGG_UNROLL
        for (auto& p : part) p = e - chunk{};
    }

    /// Returns the stored value of one lane, 0 <= lane < L. A flag is stored as -1 or 0.
    WARPAGG_HD element raw(int lane) const { return part[lane / width][lane % width]; }
    /// Returns the value of one lane, 0 <= lane < L.
    WARPAGG_HD T operator[](int lane) const {
        if constexpr (std::is_same_v<T, bool>) {
            return raw(lane) != 0;
        } else {
            return raw(lane);
        }
    }
    /// Sets the value of one lane, 0 <= lane < L.
    WARPAGG_HD void set(int lane, T value) {
        if constexpr (std::is_same_v<T, bool>) {
            part[lane / width][lane % width] = value ? -1 : 0;
        } else {
            part[lane / width][lane % width] = value;
        }
    }

/// Defines a binary operator and its assignment, lane by lane.
#define WARPAGG_LANES_OPERATOR(op)                                                       \
    friend WARPAGG_HD simd_value operator op(const simd_value& a, const simd_value& b) { \
        simd_value r;                                                                    \
        WARPAGG_UNROLL                                                                   \
        for (int i = 0; i < chunks; ++i) r.part[i] = a.part[i] op b.part[i];             \
        return r;                                                                        \
    }                                                                                    \
    WARPAGG_HD simd_value& operator op##=(const simd_value& b) { return *this = *this op b; }
    WARPAGG_LANES_OPERATOR(+)
    WARPAGG_LANES_OPERATOR(-)
    WARPAGG_LANES_OPERATOR(*)
    WARPAGG_LANES_OPERATOR(/)
    WARPAGG_LANES_OPERATOR(%)
    WARPAGG_LANES_OPERATOR(&)
    WARPAGG_LANES_OPERATOR(|)
    WARPAGG_LANES_OPERATOR(^)
    WARPAGG_LANES_OPERATOR(<<)
    WARPAGG_LANES_OPERATOR(>>)
#undef WARPAGG_LANES_OPERATOR

    /// Applies the operator lane by lane. `&&` and `||` evaluate both operands.
    /// @{
    friend WARPAGG_HD simd_value operator-(const simd_value& a) {
        simd_value r;
        WARPAGG_UNROLL
        for (int i = 0; i < chunks; ++i) r.part[i] = -a.part[i];
        return r;
    }
    friend WARPAGG_HD simd_value operator!(const simd_value& a) requires std::is_same_v<T, bool> {
        simd_value r;
        WARPAGG_UNROLL
        for (int i = 0; i < chunks; ++i) r.part[i] = ~a.part[i];
        return r;
    }
    friend WARPAGG_HD simd_value operator&&(const simd_value& a,
                                            const simd_value& b) requires std::is_same_v<T, bool> {
        return a & b;
    }
    friend WARPAGG_HD simd_value operator||(const simd_value& a,
                                            const simd_value& b) requires std::is_same_v<T, bool> {
        return a | b;
    }
    /// @}

/// Defines a comparison, lane by lane, for types that satisfy `allowed`.
#define WARPAGG_LANES_COMPARISON(op, allowed)                                                  \
    friend WARPAGG_HD simd_value<bool, L> operator op(const simd_value& a,                     \
                                                      const simd_value& b) requires(allowed) { \
        simd_value<bool, L> r;                                                                 \
        WARPAGG_UNROLL                                                                         \
        for (int i = 0; i < chunks; ++i) narrow_mask(r, i, a.part[i] op b.part[i]);            \
        return r;                                                                              \
    }
    WARPAGG_LANES_COMPARISON(<, has_order)
    WARPAGG_LANES_COMPARISON(<=, has_order)
    WARPAGG_LANES_COMPARISON(>, has_order)
    WARPAGG_LANES_COMPARISON(>=, has_order)
    WARPAGG_LANES_COMPARISON(==, true)
    WARPAGG_LANES_COMPARISON(!=, true)
#undef WARPAGG_LANES_COMPARISON

    /// Converts the 32-bit lanes of `from` that belong to chunk `i` of this 64-bit type, into `to`.
    template <class From>
    static WARPAGG_HD void widen(const simd_value<From, L>& from, int i, chunk& to) {
        const auto& both = from.part[i / 2];
        if (i % 2 == 0) {
            to = __builtin_convertvector(__builtin_shufflevector(both, both, 0, 1, 2, 3), chunk);
        } else {
            to = __builtin_convertvector(__builtin_shufflevector(both, both, 4, 5, 6, 7), chunk);
        }
    }

  private:
    template <class Chunk>
    static WARPAGG_HD void narrow_mask(simd_value<bool, L>& to, int i, const Chunk& from) {
        if constexpr (sizeof(element) == sizeof(std::int32_t)) {
            to.part[i] = from;
        } else {
            WARPAGG_UNROLL
            for (int k = 0; k < width; ++k) to.set(i * width + k, from[k] != 0);
        }
    }
};

/// The function of this name in `math`, lane by lane.
/// @{
template <class T, int L>
WARPAGG_HD simd_value<T, L> select(const simd_value<bool, L>& mask, const simd_value<T, L>& yes,
                                   const simd_value<T, L>& no) {
    simd_value<T, L> r;
    WARPAGG_UNROLL
    for (int i = 0; i < r.chunks; ++i) {
        if constexpr (sizeof(typename simd_value<T, L>::element) == sizeof(std::int32_t)) {
            r.part[i] = mask.part[i] ? yes.part[i] : no.part[i];
        } else {
            typename simd_value<std::int64_t, L>::chunk wide;
            simd_value<std::int64_t, L>::widen(mask, i, wide);
            r.part[i] = wide ? yes.part[i] : no.part[i];  // mutate: select_of_64_bits_swapped
        }
    }
    return r;
}
template <class T, int L>
WARPAGG_HD simd_value<T, L> select(const simd_value<bool, L>& mask, const simd_value<T, L>& yes,
                                   std::type_identity_t<T> no) {
    return select(mask, yes, simd_value<T, L>(no));
}

template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> min(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    simd_value<T, L> r;
    WARPAGG_UNROLL
    for (int i = 0; i < r.chunks; ++i) {
#if defined(__AVX__)
        if constexpr (std::is_same_v<T, float>) {  // GCC compares and blends if an operand is constant
            r.part[i] = reinterpret_cast<typename simd_value<T, L>::chunk>(
                _mm256_min_ps(reinterpret_cast<__m256>(b.part[i]), reinterpret_cast<__m256>(a.part[i])));
            continue;
        }
#endif
        r.part[i] = b.part[i] < a.part[i] ? b.part[i] : a.part[i];
    }
    return r;
}
template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> max(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    simd_value<T, L> r;
    WARPAGG_UNROLL
    for (int i = 0; i < r.chunks; ++i) {
#if defined(__AVX__)
        if constexpr (std::is_same_v<T, float>) {  // GCC compares and blends if an operand is constant
            r.part[i] = reinterpret_cast<typename simd_value<T, L>::chunk>(
                _mm256_max_ps(reinterpret_cast<__m256>(b.part[i]), reinterpret_cast<__m256>(a.part[i])));
            continue;
        }
#endif
        r.part[i] = a.part[i] < b.part[i] ? b.part[i] : a.part[i];
    }
    return r;
}
template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> min(const simd_value<T, L>& a, std::type_identity_t<T> b) {
    return min(a, simd_value<T, L>(b));
}
template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> max(const simd_value<T, L>& a, std::type_identity_t<T> b) {
    return max(a, simd_value<T, L>(b));
}

template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> ieee_minimum(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    if constexpr (std::is_integral_v<T>) {
        return min(a, b);
    } else {
        T all[L];  // an array, because GCC reports a vector that is set lane by lane as uninitialized
        for (int lane = 0; lane < L; ++lane) all[lane] = math::ieee_minimum(T{a[lane]}, T{b[lane]});
        simd_value<T, L> r;
        std::memcpy(r.part, all, sizeof all);
        return r;
    }
}
template <class T, int L>
requires(!std::is_same_v<T, bool>)
    WARPAGG_HD simd_value<T, L> ieee_maximum(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    if constexpr (std::is_integral_v<T>) {
        return max(a, b);
    } else {
        T all[L];
        for (int lane = 0; lane < L; ++lane) all[lane] = math::ieee_maximum(T{a[lane]}, T{b[lane]});
        simd_value<T, L> r;
        std::memcpy(r.part, all, sizeof all);
        return r;
    }
}

/// Returns a * b + c, rounded once.
template <class T, int L>
WARPAGG_HD simd_value<T, L> fma(const simd_value<T, L>& a, const simd_value<T, L>& b,
                                const simd_value<T, L>& c) {
    simd_value<T, L> r;
    WARPAGG_UNROLL
    for (int i = 0; i < r.chunks; ++i) {
#if defined(__FMA__)
        if constexpr (std::is_same_v<T, float>) {
            r.part[i] = reinterpret_cast<typename simd_value<T, L>::chunk>(
                _mm256_fmadd_ps(reinterpret_cast<__m256>(a.part[i]), reinterpret_cast<__m256>(b.part[i]),
                                reinterpret_cast<__m256>(c.part[i])));
            continue;
        }
#endif
        WARPAGG_UNROLL
        for (int k = 0; k < r.width; ++k) r.part[i][k] = math::fma(a.part[i][k], b.part[i][k], c.part[i][k]);
    }
    return r;
}

template <class T, int L>
WARPAGG_HD simd_value<T, L> sqrt(const simd_value<T, L>& a) {
    simd_value<T, L> r;
    WARPAGG_UNROLL
    for (int i = 0; i < r.chunks; ++i) {
#if defined(__AVX__)
        if constexpr (std::is_same_v<T, float>) {
            r.part[i] = reinterpret_cast<typename simd_value<T, L>::chunk>(
                _mm256_sqrt_ps(reinterpret_cast<__m256>(a.part[i])));
            continue;
        }
#endif
        WARPAGG_UNROLL
        for (int k = 0; k < r.width; ++k) r.part[i][k] = math::sqrt(a.part[i][k]);
    }
    return r;
}

template <class T, int L>
WARPAGG_HD simd_value<T, L> abs(const simd_value<T, L>& a) {
    return max(a, -a);
}
template <class T, int L>
WARPAGG_HD simd_value<T, L> inverse_sqrt(const simd_value<T, L>& a) {
    return simd_value<T, L>(T(1)) / sqrt(a);
}
template <class T, int L>
WARPAGG_HD simd_value<T, L> divide(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    return a / b;
}

template <class To, class From, int L>
WARPAGG_HD simd_value<To, L> convert(const simd_value<From, L>& a) {
    simd_value<To, L> r;
    if constexpr (sizeof(To) == sizeof(From)) {
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i)
            r.part[i] = __builtin_convertvector(a.part[i], typename simd_value<To, L>::chunk);
    } else if constexpr (sizeof(To) == 2 * sizeof(From)) {
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i) simd_value<To, L>::widen(a, i, r.part[i]);
    } else {
        WARPAGG_UNROLL
        for (int k = 0; k < L; ++k) r.set(k, static_cast<To>(a[k]));
    }
    return r;
}

/// Returns 2^x, within 1 ulp for x in [-126, 128). Other arguments are clamped to this range, because
/// no caller needs denormals, which are slow on x86. The float version computes 2^x = 2^n 2^f with
/// n = round(x) and f in [-1/2, 1/2]. For 2^f it takes the polynomial of degree 6 with p(0) = 1 and the
/// least relative error, 2e-9.
template <int L>
WARPAGG_HD simd_value<float, L> exp2(const simd_value<float, L>& x) {
    using real = simd_value<float, L>;
    using integer = simd_value<std::uint32_t, L>;  // shifting a negative exponent is defined
    const real a = min(max(x, -126.0f), 0x1.fffffep6f);
    constexpr float round = 0x1.8p23f;  // adding it leaves the nearest integer in the low bits
    const real shifted = a + real(round);
    const real f = a - (shifted - real(round));
    real p(0x1.41fba2p-13f);
    p = fma(p, f, real(0x1.5f3e32p-10f));
    p = fma(p, f, real(0x1.3b2d66p-7f));
    p = fma(p, f, real(0x1.c6af2p-5f));
    p = fma(p, f, real(0x1.ebfbdcp-3f));
    p = fma(p, f, real(0x1.62e43p-1f));
    p = fma(p, f, real(1.0f));
    integer bits, exponent;
    static_assert(sizeof bits == sizeof p);
    std::memcpy(&bits, &p, sizeof p);
    std::memcpy(&exponent, &shifted, sizeof shifted);
    bits += exponent << integer(23);
    std::memcpy(&p, &bits, sizeof p);
    return p;
}
template <int L>
WARPAGG_HD simd_value<double, L> exp2(const simd_value<double, L>& a) {
    simd_value<double, L> r;
    WARPAGG_UNROLL
    for (int k = 0; k < L; ++k) r.set(k, math::exp2(a[k]));
    return r;
}

/// Returns log2(a), within 3 ulp for normal a > 0, and -127 for zero. The float version is undefined
/// for other arguments. With a = 2^n m and m in [sqrt(1/2), sqrt(2)), log2(m) is 2 / ln 2 artanh(s) for
/// s = (m - 1) / (m + 1). Its series is cut after s^11; the relative error of the cut is 2e-11.
template <int L>
WARPAGG_HD simd_value<float, L> log2(const simd_value<float, L>& a) {
    using real = simd_value<float, L>;
    using integer = simd_value<std::int32_t, L>;
    constexpr std::int32_t least = 0x3f3504f3;  // sqrt(1/2)
    integer bits, rest;
    static_assert(sizeof bits == sizeof a);
    std::memcpy(&bits, &a, sizeof a);
    const integer n = (bits - integer(least)) >> integer(23);
    rest = bits - (n << integer(23));
    real m;
    std::memcpy(&m, &rest, sizeof m);
    const real s = (m - real(1.0f)) / (m + real(1.0f)), ss = s * s;
    real p(0x1.0c9a84p-2f);  // 2 / (11 ln 2)
    p = fma(p, ss, real(0x1.484b14p-2f));
    p = fma(p, ss, real(0x1.a61762p-2f));
    p = fma(p, ss, real(0x1.2776c6p-1f));
    p = fma(p, ss, real(0x1.ec709ep-1f));
    p = fma(p, ss, real(0x1.715476p+1f));
    return fma(p, s, convert<float>(n));
}
template <int L>
WARPAGG_HD simd_value<double, L> log2(const simd_value<double, L>& a) {
    simd_value<double, L> r;
    WARPAGG_UNROLL
    for (int k = 0; k < L; ++k) r.set(k, math::log2(a[k]));
    return r;
}

template <class T, int L>
WARPAGG_HD simd_value<std::uint32_t, L> popcount(const simd_value<T, L>& a) {
    simd_value<std::uint32_t, L> r;
    WARPAGG_UNROLL
    for (int k = 0; k < L; ++k) r.set(k, math::popcount(a[k]));
    return r;
}
template <class T, int L>
WARPAGG_HD simd_value<std::uint32_t, L> countr_zero(const simd_value<T, L>& a) {
    simd_value<std::uint32_t, L> r;
    WARPAGG_UNROLL
    for (int k = 0; k < L; ++k) r.set(k, math::countr_zero(a[k]));
    return r;
}
/// Returns a + b. Integers wrap modulo 2^bits, signed ones too.
template <class T, int L>
WARPAGG_HD simd_value<T, L> wrapping_add(const simd_value<T, L>& a, const simd_value<T, L>& b) {
    if constexpr (std::is_integral_v<T> && std::is_signed_v<T>) {
        using words =
            typename simd_value<std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>, L>::chunk;
        simd_value<T, L> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i)
            r.part[i] = reinterpret_cast<typename simd_value<T, L>::chunk>(
                reinterpret_cast<words>(a.part[i]) + reinterpret_cast<words>(b.part[i]));
        return r;
    } else {
        return a + b;
    }
}

template <class T, int L>
WARPAGG_HD T uniform(const simd_value<T, L>& a) {
    return a[0];
}
/// @}

/// Makes the functions available in `math`, for masked code that qualifies calls. Argument-dependent
/// lookup finds them for unqualified calls.
namespace math {
using warpagg::abs;
using warpagg::convert;
using warpagg::countr_zero;
using warpagg::divide;
using warpagg::exp2;
using warpagg::fma;
using warpagg::inverse_sqrt;
using warpagg::log2;
using warpagg::max;
using warpagg::min;
using warpagg::popcount;
using warpagg::select;
using warpagg::sqrt;
using warpagg::uniform;
using warpagg::wrapping_add;
}  // namespace math

/// @cond deprecated
template <class T, int L>
using lanes [[deprecated("use simd_value")]] = simd_value<T, L>;
/// @endcond

}  // namespace warpagg
