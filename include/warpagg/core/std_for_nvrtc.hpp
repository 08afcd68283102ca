// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The parts of the standard library that warpagg uses. NVRTC has no standard library, so under NVRTC this
/// header defines them in `warpagg::std`. Code in `warpagg` finds that namespace before the global `std`,
/// so NVRTC needs no include path besides warpagg's, and the global `std` stays as it is.

#if !defined(__CUDACC_RTC__)

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#else

namespace warpagg::std {

using size_t = decltype(sizeof 0);
using ptrdiff_t = decltype(static_cast<char*>(nullptr) - static_cast<char*>(nullptr));
using int64_t = long long;
using uint32_t = unsigned;
using uint64_t = unsigned long long;
using uintptr_t = size_t;

using ::memcpy;

template <bool C, class Yes, class No>
struct conditional {
    using type = Yes;
};
template <class Yes, class No>
struct conditional<false, Yes, No> {
    using type = No;
};
template <bool C, class Yes, class No>
using conditional_t = typename conditional<C, Yes, No>::type;

template <class A, class B>
inline constexpr bool is_same_v = false;
template <class A>
inline constexpr bool is_same_v<A, A> = true;

template <class T, class... Any>
inline constexpr bool is_one_of = (... || is_same_v<T, Any>);

template <class T>
inline constexpr bool is_integral_v =
    is_one_of<T, bool, char, signed char, unsigned char, short, unsigned short, int, unsigned, long,
              unsigned long, long long, unsigned long long>;
template <class T>
inline constexpr bool is_arithmetic_v = is_integral_v<T> || is_one_of<T, float, double>;
template <class T>
inline constexpr bool is_signed_v = false;
template <class T>
requires is_arithmetic_v<T>
inline constexpr bool is_signed_v<T> = static_cast<T>(-1) < static_cast<T>(0);

template <class A, class B>
concept same_as = is_same_v<A, B> && is_same_v<B, A>;
template <class From, class To>
concept convertible_to = requires(From from, void (&take)(To)) {
    take(static_cast<From&&>(from));
};

}  // namespace warpagg::std

#endif
