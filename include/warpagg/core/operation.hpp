// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The operations that combine two values. Each is associative and has an atomic in memory. The
/// default is `operation::sum`; a policy selects another one, as in `policy{maximum}`.

#include "axis.hpp"
#include "math.hpp"

namespace warpagg {

/// Tags that select which threads see the atomics. A wider scope may be slower.
namespace scope {

/// The threads of the block. Use it for destinations in shared memory, or in global memory that only
/// this block uses.
struct block {
    static constexpr auto axis = warpagg::axis::scope;
};
/// The threads of the GPU; the default.
struct device {
    static constexpr auto axis = warpagg::axis::scope;
};
/// The threads of all GPUs and of the CPU. Use it for destinations in memory that they share.
struct system {
    static constexpr auto axis = warpagg::axis::scope;
};

}  // namespace scope

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

/// The base class of `minimum` and `maximum`, for floats and for integers of 32 and 64 bits. Floats
/// compare as in IEEE 754-2019: NaN wins over every number, and -0 is smaller than +0.
struct for_ordered : for_integers {
    /// Is true for float and double.
    template <class T>
    static constexpr bool is_float = std::is_same_v<T, float> || std::is_same_v<T, double>;
    template <class T>
    static constexpr bool suits = is_float<T> || for_integers::suits<T>;
};

/// Takes the smaller value.
struct minimum : for_ordered {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::ieee_minimum;
        return ieee_minimum(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        if constexpr (is_float<T>) {
            return math::infinity<T>();
        } else {
            return static_cast<T>(~least<T>);  // mutate: minimum_from_zero
        }
    }
};

/// Takes the larger value.
struct maximum : for_ordered {
    template <class V>
    WARPAGG_HD static V combine(const V& a, const V& b) {
        using math::ieee_maximum;
        return ieee_maximum(a, b);
    }
    template <class T>
    WARPAGG_HD static T identity() {
        if constexpr (is_float<T>) {
            return -math::infinity<T>();
        } else {
            return least<T>;  // mutate: maximum_from_zero
        }
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

/// An operation whose atomics are visible to the threads of a scope. Models without scopes, such as
/// the emulators, treat it as `Op`.
template <class Op, class Scope>
struct scoped : Op {
    using scope = Scope;  ///< which threads see the atomics
};

namespace detail {
template <class Op>
struct scope_of {
    using type = warpagg::scope::device;
};
template <class Op, class Scope>
struct scope_of<scoped<Op, Scope>> {
    using type = Scope;
};
}  // namespace detail
/// The scope of an operation: `scope::device`, unless the operation is `scoped`.
template <class Op>
using scope_of = typename detail::scope_of<Op>::type;

/// Is satisfied by the sum, also by a `scoped` one.
template <class Op>
concept is_sum = std::convertible_to<Op, sum>;

}  // namespace operation

inline namespace tags {

/// An operation as an object, for `policy{...}`.
/// @{
WARPAGG_TAG operation::minimum minimum{};
WARPAGG_TAG operation::maximum maximum{};
WARPAGG_TAG operation::bit_and bit_and{};
WARPAGG_TAG operation::bit_or bit_or{};
WARPAGG_TAG operation::bit_xor bit_xor{};
/// @}

/// A scope as an object, for `policy{...}`.
/// @{
WARPAGG_TAG scope::block block_scope{};
WARPAGG_TAG scope::device device_scope{};
WARPAGG_TAG scope::system system_scope{};
/// @}

}  // namespace tags
}  // namespace warpagg
