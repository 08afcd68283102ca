// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The operations that combine two values. Each is associative and has an atomic in memory. The
/// default is `operation::sum`; a policy selects another one, as in `policy{maximum}`.

#include "axis.hpp"
#include "math.hpp"

namespace warpagg {

/// Each operation has three members. `combine(a, b)` combines scalars or SIMD values, lane by lane.
/// `identity<T>()` is the contribution of an inactive lane. `suits<T>` tells whether an atomic
/// exists for T.
namespace operation {

/// Adds floats, integers (modulo 2^bits) and pairs of 16-bit floats.
struct sum {
    static constexpr auto axis = warpagg::axis::operation;
    template <class T>
    static constexpr bool suits = !std::is_integral_v<T> || sizeof(T) >= 4;
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::wrapping_add;
        return wrapping_add(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return T{};
    }
};

/// The base class of operations on 32-bit and 64-bit integers.
struct for_integers {
    static constexpr auto axis = warpagg::axis::operation;
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && sizeof(T) >= 4;
    /// The smallest value of T.
    template <class T>
    static constexpr T least = std::is_signed_v<T> ? static_cast<T>(T{1} << (8 * sizeof(T) - 1)) : T{};
};

/// Takes the smaller value.
struct minimum : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::min;
        return min(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return static_cast<T>(~least<T>);  // mutate: minimum_from_zero
    }
};

/// Takes the larger value.
struct maximum : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::max;
        return max(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return least<T>;  // mutate: maximum_from_zero
    }
};

/// Bitwise AND.
struct bit_and : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        return a & b;
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return static_cast<T>(~T{});  // mutate: bit_and_from_zero
    }
};

/// Bitwise OR.
struct bit_or : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        return a | b;
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return T{};
    }
};

/// The base class for user-defined operations on 64-bit unsigned integers. `Op` derives from it and
/// has a static `combine_words(a, b)` that is associative and commutative, with zero as its identity.
/// Cost: memory combines by a compare-and-swap loop, which is slow under contention.
template <class Op>
struct on_words {
    static constexpr auto axis = warpagg::axis::operation;
    static constexpr bool by_exchange = true;  ///< commits use compare-and-swap
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && !std::is_signed_v<T> && sizeof(T) == 8;
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        if constexpr (requires { typename V::scalar; }) {
            constexpr int size = V::chunks * V::width;
            // An array, because GCC reports a vector that is set lane by lane as uninitialized.
            typename V::scalar words[size];
            for (int lane = 0; lane < size; ++lane) words[lane] = Op::combine_words(a[lane], b[lane]);
            V r;
            std::memcpy(r.part, words, sizeof words);
            return r;
        } else {
            return Op::combine_words(a, b);
        }
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return T{};
    }
};

/// Bitwise XOR.
struct bit_xor : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        return a ^ b;
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return T{};
    }
};

}  // namespace operation

/// An operation as an object, for `policy{...}`.
/// @{
WARPAGG_TAG operation::minimum minimum{};
WARPAGG_TAG operation::maximum maximum{};
WARPAGG_TAG operation::bit_and bit_and{};
WARPAGG_TAG operation::bit_or bit_or{};
WARPAGG_TAG operation::bit_xor bit_xor{};
/// @}

}  // namespace warpagg
