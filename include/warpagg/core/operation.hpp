// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The operations that combine values: associative, with an atomic in memory. The default is
/// `operation::sum`; the others are tags of a policy, as in `policy{maximum}`.

#include "axis.hpp"
#include "math.hpp"

namespace warpagg {

/// Each has `combine(a, b)`, for scalars and lane by lane; `identity<T>()`, the contribution of an
/// inactive lane; and `suits<T>`, whether memory supports the operation for T.
namespace operation {

/// Addition of floats, of integers (modulo 2^bits) and of pairs of halves.
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

/// Base of operations on 32-bit and 64-bit integers.
struct for_integers {
    static constexpr auto axis = warpagg::axis::operation;
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && sizeof(T) >= 4;
    /// The smallest T.
    template <class T>
    static constexpr T least = std::is_signed_v<T> ? static_cast<T>(T{1} << (8 * sizeof(T) - 1)) : T{};
};

/// The smallest value.
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

/// The largest value.
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

/// A base for operations of your own on 64-bit words. `Op` derives from it and has
/// `combine_words(a, b)`, associative and commutative, with zero as its identity. Memory combines
/// by compare-and-swap.
template <class Op>
struct on_words {
    static constexpr auto axis = warpagg::axis::operation;
    static constexpr bool by_exchange = true;  ///< by compare-and-swap, as no atomic instruction exists
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && !std::is_signed_v<T> && sizeof(T) == 8;
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        if constexpr (requires { typename V::scalar; }) {
            constexpr int size = V::chunks * V::width;
            // Not set lane by lane in a vector, which GCC takes for uninitialized.
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

/// The tag as an object, for `policy{...}`.
/// @{
WARPAGG_TAG operation::minimum minimum{};
WARPAGG_TAG operation::maximum maximum{};
WARPAGG_TAG operation::bit_and bit_and{};
WARPAGG_TAG operation::bit_or bit_or{};
WARPAGG_TAG operation::bit_xor bit_xor{};
/// @}

}  // namespace warpagg
