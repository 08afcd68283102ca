// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// What values are combined by: the associative operations that memory has an atomic for. The default is
/// `operation::sum`; the others are tags of a policy, e.g. `policy{maximum}`.

#include "axis.hpp"
#include "math.hpp"

namespace warpagg {

/// Each has `combine(a, b)`, which works lane by lane too; `identity<T>()`, which an inactive lane
/// contributes; and `suits<T>`, whether memory has the operation for T.
namespace operation {

/// Addition: of floats, of integers (modulo 2^bits), of pairs of halves.
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

/// Of integers of 32 or 64 bits.
struct for_integers {
    static constexpr auto axis = warpagg::axis::operation;
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && sizeof(T) >= 4;
    /// The sign bit of a signed T alone, zero if T is unsigned: T's least value.
    template <class T>
    static constexpr T least = std::is_signed_v<T> ? static_cast<T>(T{1} << (8 * sizeof(T) - 1)) : T{};
};

/// The least value.
struct minimum : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::min;
        return min(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return static_cast<T>(~least<T>);
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
        return least<T>;
    }
};

/// The bits that all values have.
struct bit_and : for_integers {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        return a & b;
    }
    template <class T>
    WARPAGG_HD static T identity() {
        return static_cast<T>(~T{});
    }
};

/// The bits that some value has.
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

/// A base for operations of your own, on words of 64 bits: `Op` derives from it and has
/// `combine_words(a, b)`, associative, commutative, and with zero as its neutral element. Memory combines by
/// compare-and-swap.
template <class Op>
struct on_words {
    static constexpr auto axis = warpagg::axis::operation;
    static constexpr bool by_exchange = true;  ///< no atomic instruction has it
    template <class T>
    static constexpr bool suits = std::is_integral_v<T> && !std::is_signed_v<T> && sizeof(T) == 8;
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        if constexpr (requires { typename V::scalar; }) {
            constexpr int size = V::chunks * V::width;
            typename V::scalar words[size];  // GCC takes a vector that is set lane by lane for uninitialized
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

/// The bits that an odd number of values have.
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
