// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the tests of the library call it with: which lanes are active, what values active and inactive lanes
/// hold, where records lie; and what operations mean, said once more and independently.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>
#include <warpagg/atomic.hpp>

namespace {

constexpr unsigned width = backend::warp::size;

/// One bit per lane. Warps of fewer than 32 lanes ignore the upper bits.
using lane_bits = warpagg::lane_bits_t<backend::warp>;

using warpagg::mask_t;
using warpagg::value_t;
namespace operation = warpagg::operation;

/// None and all; and of each lane alone, the first n, and some at random, every nth.
inline std::vector<lane_bits> masks(std::size_t nth = backend::every_nth_mask) {
    constexpr lane_bits one = 1;
    constexpr unsigned bits = std::numeric_limits<lane_bits>::digits;
    std::vector<lane_bits> all{0u, ~lane_bits{0}};
    for (unsigned lane = 0; lane < bits; ++lane) all.push_back(one << lane);
    for (unsigned n = 2; n < bits; ++n) all.push_back((one << n) - 1u);
    std::mt19937 random(7);
    std::uniform_int_distribution<lane_bits> any;
    for (int i = 0; i < 20; ++i) all.push_back(any(random));
    std::vector<lane_bits> some{all[0], all[1]};
    for (std::size_t i = 2; i < all.size(); i += nth) some.push_back(all[i]);
    return some;
}

/// How the values of a case are drawn. Sums of signed zeros show whether a lane was masked by zero; and the
/// scales, whether the tree is the promised one. None makes a denormal: `RED` flushes them.
enum class kind { one_scale, many_scales, zeros };
constexpr kind kinds[] = {kind::one_scale, kind::many_scales, kind::zeros};

/// Values of T. What is no number has a specialization.
template <class T>
struct values_of {
    /// The value of an active lane.
    static T draw(kind k, std::mt19937_64& random) {
        if constexpr (std::is_floating_point_v<T>) {
            const T sign = random() % 2 == 0 ? T(1) : T(-1);
            if (k == kind::zeros) return sign * T(0);
            const int range = k == kind::one_scale ? 3 : 30;
            const int exponent = static_cast<int>(random() % static_cast<unsigned>(2 * range + 1)) - range;
            const auto mantissa = static_cast<T>(1.0 + std::ldexp(static_cast<double>(random() >> 11), -53));
            return sign * std::ldexp(mantissa, exponent);
        } else {
            return static_cast<T>(random());
        }
    }

    /// The value of an inactive lane: the one that does most harm in a result.
    static T poison(unsigned number) {
        using limits = std::numeric_limits<T>;
        if constexpr (std::is_floating_point_v<T>) {
            const T all[] = {limits::quiet_NaN(), limits::infinity(), -limits::infinity(), limits::max(),
                             T(1)};
            return all[number % 5];
        } else {
            const T all[] = {limits::min(), limits::max(), T(1)};
            return all[number % 3];
        }
    }
};

template <class T>
bool same_bits(T a, T b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <class T>
bool same_memory(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T>
std::string text_of(const T& value) {
    std::ostringstream text;
    if constexpr (std::is_arithmetic_v<T>) {
        text << std::setprecision(20) << value;
    } else {
        std::uint32_t bits;
        static_assert(sizeof bits == sizeof value);
        std::memcpy(&bits, &value, sizeof bits);
        text << "bits " << std::hex << bits;
    }
    return text.str();
}

// ------------------------------------------------------------------------------------- what operations mean

template <class T>
T combined(operation::sum, T a, T b) {
    if constexpr (std::is_integral_v<T>) {  // modulo 2^bits
        return static_cast<T>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
    } else {
        return a + b;
    }
}
/// Of floats as in IEEE 754-2019: NaN wins, and -0 is smaller than +0.
template <class T>
T combined(operation::minimum, T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<T>::quiet_NaN();
        if (a == b) return std::signbit(a) ? a : b;
    }
    return std::min(a, b);
}
template <class T>
T combined(operation::maximum, T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<T>::quiet_NaN();
        if (a == b) return std::signbit(a) ? b : a;
    }
    return std::max(a, b);
}
template <class T>
T combined(operation::bit_and, T a, T b) {
    return a & b;
}
template <class T>
T combined(operation::bit_or, T a, T b) {
    return a | b;
}
template <class T>
T combined(operation::bit_xor, T a, T b) {
    return a ^ b;
}

/// The neutral element: combines with x to x, for every x but the sum's -0.
template <class T, class Op>
T neutral(Op) {
    using limits = std::numeric_limits<T>;
    if constexpr (std::is_same_v<Op, operation::minimum>) {
        return limits::max();
    } else if constexpr (std::is_same_v<Op, operation::maximum>) {
        return limits::lowest();
    } else if constexpr (std::is_same_v<Op, operation::bit_and>) {
        return static_cast<T>(std::is_signed_v<T> ? T(-1) : limits::max());
    } else {
        return T{};
    }
}

/// The tree that the documentation promises: pairs of lanes at distance W/2, then W/4, and so on to 1.
template <class Op, class T>
T over_tree(Op op, std::vector<T> x) {
    for (std::size_t distance = x.size() / 2; distance > 0; distance /= 2)
        for (std::size_t lane = 0; lane < distance; ++lane)
            x[lane] = combined(op, x[lane], x[lane + distance]);
    return x[0];
}

/// In whatever order `own` are added to `before`, the sums stay this close to that of one order: each is at
/// most W u times the sum of magnitudes from the exact one. Nothing for other types than floats, which
/// come out the same in any order.
template <class T>
long double any_order_error(T before, const std::vector<T>& own) {
    if constexpr (std::is_floating_point_v<T>) {
        if (own.size() < 2) return 0;
        long double magnitude = std::fabs(static_cast<long double>(before));
        for (const T& x : own) magnitude += std::fabs(static_cast<long double>(x));
        const long double u = static_cast<long double>(std::numeric_limits<T>::epsilon()) / 2;
        return 2 * width * u * magnitude;
    } else {
        return 0;
    }
}

// --------------------------------------------------------------------------------------- where records lie

/// Where component i of case c lies, counted in values from the memory's start.
struct layout {
    unsigned first, component_step, case_step, size;
    WARPAGG_HD unsigned at(unsigned c, unsigned i) const {
        return first + c * case_step + i * component_step;
    }
};

constexpr unsigned guard = 3;  // odd, so that records start at every alignment

inline layout records(unsigned cases, unsigned n) {
    return {guard, 1, n + guard, guard + cases * (n + guard)};
}
inline layout structure_of_arrays(unsigned cases, unsigned n) {
    return {guard, cases + guard, 1, guard + n * (cases + guard)};
}

/// The expected memory at the end, and its tolerance.
template <class T>
struct expectation {
    std::vector<T> value;
    std::vector<long double> tolerance;

    explicit expectation(const std::vector<T>& before) : value(before), tolerance(before.size(), 0.0L) {}

    /// Where and how `after` differs first from this; nothing if it does not.
    std::string first_difference(const std::vector<T>& after) const {
        for (std::size_t k = 0; k < value.size(); ++k) {
            if (same_bits(after[k], value[k])) continue;
            if constexpr (std::is_floating_point_v<T>) {
                const auto error =
                    std::fabs(static_cast<long double>(after[k]) - static_cast<long double>(value[k]));
                if (tolerance[k] > 0 && error <= tolerance[k]) continue;  // otherwise -0 would pass for +0
            }
            std::ostringstream text;
            text << "cell " << k << " of " << value.size() << ": " << text_of(after[k]) << ", expected "
                 << text_of(value[k]) << " +- " << tolerance[k];
            return text.str();
        }
        return "";
    }
};

}  // namespace
