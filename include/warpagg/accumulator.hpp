// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// How a sum of floats is kept, in the warp and in memory. The kinds differ in their error bounds and in
/// whether the order of additions changes the result. n is the number of additions to a sum S, k its
/// condition number sum|x| / |S|, u = 2^-24. docs/policies.md lists their costs.

#include "core/axis.hpp"
#include "core/operation.hpp"
#include "detail/accumulate/superaccumulator.hpp"

namespace warpagg {

/// Each kind but `native` decomposes a float into `limbs` values of type `limb` by `decompose`. `operation`
/// combines limbs, and `value` converts summed limbs to a float.
namespace accumulate {

/// The values' own type. Error: (n/32 + 5) u k if all lanes are active, n u k at most. The order shows.
struct native {
    static constexpr auto axis = warpagg::axis::accumulate;
};

/// Double. Error: n 2^-53 k + u. The order shows.
struct f64 {
    static constexpr auto axis = warpagg::axis::accumulate;
    /// See the namespace.
    /// @{
    using limb = double;
    static constexpr int limbs = 1;
    using operation = warpagg::operation::sum;
    WARPAGG_HD static void decompose(float x, limb (&to)[limbs]) { to[0] = static_cast<double>(x); }
    WARPAGG_HD static float value(const limb (&sum)[limbs]) { return static_cast<float>(sum[0]); }
    /// @}

    /// @cond deprecated
    using number [[deprecated("use limb")]] = limb;
    [[deprecated("use limbs")]] static constexpr int numbers = limbs;
    [[deprecated("use decompose")]] WARPAGG_HD static void split(float x, limb (&to)[limbs]) {
        decompose(x, to);
    }
    /// @endcond
};

/// Two floats, of which the second has what rounding took from the first (Joldes et al. 2017, algorithm 5).
/// Error: u + 5 n u^2 k. The order shows. Memory adds by compare-and-swap.
/// Precondition: not compiled with -ffast-math, which takes the second for zero. With nvcc's -ftz=true
/// denormals are zero here as elsewhere.
struct compensated {
    static constexpr auto axis = warpagg::axis::accumulate;
    using limb = std::uint64_t;  ///< the bits of both, the first in the lower half
    /// See the namespace.
    /// @{
    static constexpr int limbs = 1;
    /// Adds pairs.
    struct operation : warpagg::operation::on_words<operation> {
        /// See `on_words`.
        WARPAGG_HD static std::uint64_t combine_words(std::uint64_t a, std::uint64_t b) {
            const float x = half(a), y = half(b), sum = x + y;
            const float of_y = sum - x, error = (x - (sum - of_y)) + (y - of_y);
            const float rest = half(a >> 32) + half(b >> 32) + error;
            const float first = sum + rest, second = rest - (first - sum);
            // Beyond the largest float there is no rest, only NaN.
            return first - first == 0 ? word(first, second) : word(sum, 0);
        }
    };

    WARPAGG_HD static void decompose(float x, limb (&to)[limbs]) { to[0] = word(x, 0); }
    WARPAGG_HD static float value(const limb (&sum)[limbs]) { return half(sum[0]) + half(sum[0] >> 32); }
    /// @}

    /// @cond deprecated
    using number [[deprecated("use limb")]] = limb;
    [[deprecated("use limbs")]] static constexpr int numbers = limbs;
    [[deprecated("use decompose")]] WARPAGG_HD static void split(float x, limb (&to)[limbs]) {
        decompose(x, to);
    }
    /// @endcond

  private:
    WARPAGG_HD static float half(std::uint64_t bits) {
        const auto word = static_cast<std::uint32_t>(bits);
        float x;
        std::memcpy(&x, &word, sizeof x);
        return x;
    }
    WARPAGG_HD static std::uint64_t word(float first, float second) {
        std::uint32_t bits[2];
        std::memcpy(&bits[0], &first, sizeof first);
        std::memcpy(&bits[1], &second, sizeof second);
        return bits[0] | std::uint64_t{bits[1]} << 32;
    }
};

/// An integer of 64 bits in units of 2^-Q / scale. Error: n 2^-(Q+1) / scale + u |S|. The same bits in any
/// order.
///
/// A value that is not finite, or of 2^(63-LogValues-Q) / scale or more, is left out, and `*fault` becomes 1,
/// where it stays: as long as it is 0 no sum of fewer than 2^LogValues values has overflowed.
///
/// @snippet accumulate.cpp fixed
template <int Q, int LogValues = 25>
struct fixed {
    static_assert(Q >= -100 && Q <= 149, "fixed<Q> takes -100 <= Q <= 149");
    static_assert(LogValues >= 1 && LogValues <= 39, "fixed<Q, LogValues> takes 1 <= LogValues <= 39");
    static constexpr auto axis = warpagg::axis::accumulate;
    /// See the namespace.
    /// @{
    using limb = std::int64_t;
    static constexpr int limbs = 1;
    using operation = warpagg::operation::sum;
    /// @}

    std::uint32_t* fault = nullptr;  ///< in memory, where the sums are; null if nobody is to be told
    float scale = 1;                 ///< a power of two; sums are to be divided by it: see `scale_to_fit`

    /// Whether x could be taken.
    WARPAGG_HD bool decompose(float x, limb (&to)[limbs]) const {
        const double units = static_cast<double>(x) * static_cast<double>(scale) * power_of_two(Q);
        const double room = power_of_two(63 - LogValues);
        const bool fits = parts_of_float(x).finite && units < room && units > -room;
        to[0] = fits ? static_cast<std::int64_t>(::llrint(units)) : 0;
        return fits;
    }
    /// Of sums of values that were scaled, scaled.
    WARPAGG_HD static float value(const limb (&sum)[limbs]) {
        return static_cast<float>(static_cast<double>(sum[0]) * power_of_two(-Q));
    }

    /// The largest scale by which values up to this in magnitude fit, as far as a float can be.
    /// Precondition: it is finite.
    static WARPAGG_HD float scale_to_fit(float largest) {
        const double room = power_of_two(63 - LogValues - Q);
        const double magnitude = static_cast<double>(largest < 0 ? -largest : largest);
        float scale = 1;
        if (magnitude == 0) return scale;
        while (magnitude * static_cast<double>(scale) >= room && scale > 0x1p-126f) scale *= 0.5f;
        while (magnitude * static_cast<double>(scale) * 2 < room && scale < 0x1p126f) scale *= 2;
        return scale;
    }

    /// @cond deprecated
    using number [[deprecated("use limb")]] = limb;
    [[deprecated("use limbs")]] static constexpr int numbers = limbs;
    [[deprecated("use decompose")]] WARPAGG_HD bool split(float x, limb (&to)[limbs]) const {
        return decompose(x, to);
    }
    /// @endcond

  private:
    WARPAGG_HD static double power_of_two(int exponent) {
        const auto bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
        double power;
        std::memcpy(&power, &bits, sizeof power);
        return power;
    }
};

/// K words, each the integer sum of what values have in one window of 24 bits: word i has the highest window
/// in use of those whose number is i modulo K (indexed summation: Demmel and Nguyen 2015). Error: n 2^(24
/// (1-K)) max|x| + u |S|. The same bits in any order, for up to 2^31 values; infinities and NaN add up as in
/// IEEE 754. Memory adds by compare-and-swap.
template <unsigned K>
struct binned {
    static_assert(K >= 2 && K <= 8, "binned<K> takes 2 <= K <= 8 windows");
    static constexpr auto axis = warpagg::axis::accumulate;
    using limb =
        std::uint64_t;  ///< a window's number, from 1, in the upper 8 bits, a signed sum in the others
    /// See the namespace.
    /// @{
    static constexpr int limbs = K;

    /// Of two windows' sums the higher one; the sum of both if the window is the same.
    struct operation : warpagg::operation::on_words<operation> {
        /// See `on_words`.
        WARPAGG_HD static std::uint64_t combine_words(std::uint64_t a, std::uint64_t b) {
            const std::uint64_t of_a = a >> 56, of_b = b >> 56;
            if (of_a != of_b) return of_a > of_b ? a : b;
            return of_a == infinite ? a | b : word(of_a, a + b);
        }
    };

    WARPAGG_HD static void decompose(float x, limb (&to)[limbs]) {
        const parts_of_float p(x);
        const std::uint64_t wide = std::uint64_t{p.significand} << p.bit % window;
        const std::uint64_t low = wide & ((1u << window) - 1), high = wide >> window;
        const unsigned number = p.bit / window + 1;
        const std::uint64_t words[2] = {low == 0 ? 0 : word(number, p.negative ? 0 - low : low),
                                        high == 0 ? 0 : word(number + 1, p.negative ? 0 - high : high)};
        const std::uint64_t signs = (p.nan || !p.negative ? 1u : 0u) | (p.nan || p.negative ? 2u : 0u);
        WARPAGG_UNROLL
        for (unsigned k = 0; k < K; ++k) {  // without an index known at run time: in registers
            to[k] = number % K == k ? words[0] : (number + 1) % K == k ? words[1] : 0;
            if (!p.finite) to[k] = k == 0 ? word(infinite, signs) : 0;
        }
    }

    WARPAGG_HD static float value(const limb (&sum)[limbs]) {
        if (sum[0] >> 56 == infinite) return sum_of_infinities((sum[0] & 1u) != 0, (sum[0] & 2u) != 0);
        superaccumulator exact;
        for (const auto word : sum) {
            const std::uint64_t number = word >> 56;
            if (number == 0) continue;
            const std::int64_t signed_sum = static_cast<std::int64_t>(word << 8) >> 8;
            exact.add(signed_sum, static_cast<unsigned>(number - 1) * window);
        }
        return exact.nearest();
    }
    /// @}

    /// @cond deprecated
    using number [[deprecated("use limb")]] = limb;
    [[deprecated("use limbs")]] static constexpr int numbers = limbs;
    [[deprecated("use decompose")]] WARPAGG_HD static void split(float x, limb (&to)[limbs]) {
        decompose(x, to);
    }
    /// @endcond

  private:
    static constexpr unsigned window = 24;           // bits
    static constexpr std::uint64_t infinite = 0xff;  // above all windows
    WARPAGG_HD static std::uint64_t word(std::uint64_t number, std::uint64_t sum) {
        return number << 56 | (sum & 0xffffffffffffffu);
    }
};

/// All bits that a float can have, in nine words of 32 and their carries (a superaccumulator: Kulisch;
/// Collange et al. 2015), and a tenth for what is infinite. Error: half an ulp, the sum is rounded once. The
/// same bits in any order, for up to 2^31 values; infinities and NaN add up as in IEEE 754.
struct exact {
    static constexpr auto axis = warpagg::axis::accumulate;
    /// See the namespace.
    /// @{
    using limb = std::int64_t;
    static constexpr int limbs = 10;
    using operation = warpagg::operation::sum;

    WARPAGG_HD static void decompose(float x, limb (&to)[limbs]) {
        const parts_of_float p(x);
        const std::uint64_t wide = std::uint64_t{p.significand} << p.bit % 32;
        const std::int64_t low = static_cast<std::int64_t>(wide & 0xffffffffu),
                           high = static_cast<std::int64_t>(wide >> 32);
        const int first = static_cast<int>(p.bit / 32);
        for (int i = 0; i + 1 < limbs; ++i) {  // without an index known at run time: in registers
            const std::int64_t part = !p.finite ? 0 : i == first ? low : i == first + 1 ? high : 0;
            to[i] = p.negative ? -part : part;
        }
        const bool positive = p.nan || !p.negative, negative = p.nan || p.negative;
        to[limbs - 1] = p.finite ? 0 : (positive ? 1 : 0) + (negative ? std::int64_t{1} << 32 : 0);
    }

    WARPAGG_HD static float value(const limb (&sum)[limbs]) {
        if (sum[limbs - 1] != 0)
            return sum_of_infinities((sum[limbs - 1] & 0xffffffff) != 0, sum[limbs - 1] >> 32 != 0);
        superaccumulator whole;
        for (unsigned i = 0; i + 1 < limbs; ++i) whole.limb[i] = sum[i];
        return whole.nearest();
    }
    /// @}

    /// @cond deprecated
    using number [[deprecated("use limb")]] = limb;
    [[deprecated("use limbs")]] static constexpr int numbers = limbs;
    [[deprecated("use decompose")]] WARPAGG_HD static void split(float x, limb (&to)[limbs]) {
        decompose(x, to);
    }
    /// @endcond
};

/// Float while a warp adds up what its lanes have, as `native`; in memory what A is, which takes each warp's
/// sum apart. Error: 5 u k and A's, of as many values as there are warps with an active lane. The order of
/// warps shows where A's does; which values a warp has shows. Cost: of one taking apart a warp and component
/// instead of one a lane and component, and native's shuffles. `warp_reduce_atomic` only.
///
/// @snippet accumulate.cpp between_warps
template <class A>
struct between_warps : A {
    static_assert(
        requires { typename A::limb; } && !requires { typename A::storage; },
        "between_warps is of f64, compensated, fixed<Q>, binned<K> or exact");
    using storage = A;  ///< kind of the accumulators in memory
    /// @cond deprecated
    using kept [[deprecated("use storage")]] = storage;
    /// @endcond
};

}  // namespace accumulate

/// A sum in memory, kept as `Accumulate` specifies. An accumulator of zero bytes is an empty sum.
template <class Accumulate>
struct accumulator {
    typename Accumulate::limb limb[Accumulate::limbs]{};  ///< see `Accumulate`
    /// The sum, as a float.
    WARPAGG_HD float value() const { return Accumulate::value(limb); }
};

/// The tag as an object, for `policy{...}`.
/// @{
WARPAGG_TAG accumulate::native native{};
WARPAGG_TAG accumulate::f64 f64{};
WARPAGG_TAG accumulate::compensated compensated{};
template <unsigned K>
WARPAGG_TAG accumulate::binned<K> binned{};
WARPAGG_TAG accumulate::exact exact{};
template <class A>
constexpr WARPAGG_HD accumulate::between_warps<A> between_warps(const A& how) {
    return {how};
}
/// @}

/// @cond deprecated
template <class Accumulate>
using cell [[deprecated("use accumulator")]] = accumulator<Accumulate>;
/// @endcond

}  // namespace warpagg
