// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Accumulators: how a sum of floats is kept, in the warp and in memory. The tags differ in their
/// error bounds, in determinism and in cost; docs/reference/policies.md lists the costs. In the bounds, n is
/// the number of additions to a sum S, k = sum|x| / |S| is its condition number, and u = 2^-24.

#include "core/axis.hpp"
#include "core/operation.hpp"
#include "detail/accumulate/superaccumulator.hpp"

namespace warpagg {

/// Accumulate tags. Each tag but `native` has these members: `decompose` decomposes a float into
/// `limbs` limbs of type `limb`, `operation` combines limbs, and `value` converts summed limbs to a
/// float.
namespace accumulate {

/// Keeps the sum in the type of the values. Error of a float sum on W lanes: at most
/// (n/W + log2 W) u k if all lanes are active, and n u k otherwise. The result depends on the order of
/// additions (`not_guaranteed`). Memory per sum: one value. Cost per commit: one atomic.
struct native {
    static constexpr auto axis = warpagg::axis::accumulate;
};

/// Keeps the sum in a double. Error: at most n 2^-53 k + u. The result depends on the order of
/// additions (`not_guaranteed`). Memory per sum: 8 bytes. Cost per commit: one atomic.
struct f64 {
    static constexpr auto axis = warpagg::axis::accumulate;
    /// A member of every accumulate tag: see the namespace.
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

/// Keeps the sum in two floats; the second one holds the rounding error of the first. Error: at most
/// u + 5 n u^2 k. The result depends on the order of additions (`not_guaranteed`). Memory per sum:
/// 8 bytes. Cost per commit: one compare-and-swap loop. Precondition: not compiled with
/// -ffast-math, which removes the second float. With nvcc's -ftz=true denormals become zero.
/// Source: Joldes et al. 2017, algorithm 5.
struct compensated {
    static constexpr auto axis = warpagg::axis::accumulate;
    using limb = std::uint64_t;  ///< the bits of both floats, the first float in the lower half
    /// A member of every accumulate tag: see the namespace.
    /// @{
    static constexpr int limbs = 1;
    /// Adds two pairs of floats.
    struct operation : warpagg::operation::on_words<operation> {
        /// Combines two limbs: see `on_words`.
        WARPAGG_HD static std::uint64_t combine_words(std::uint64_t a, std::uint64_t b) {
            const float x = half(a), y = half(b), sum = x + y;
            const float of_y = sum - x, error = (x - (sum - of_y)) + (y - of_y);
            const float rest = half(a >> 32) + half(b >> 32) + error;
            const float first = sum + rest, second = rest - (first - sum);
            // If the sum is not finite, the rest would be NaN.
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

/// Keeps the sum in fixed point: a 64-bit integer in units of 2^-Q / scale. Error: at most
/// n 2^-(Q+1) / scale + u |S|. The result has the same bits for any order of additions
/// (`gpu_to_gpu`). Memory per sum: 8 bytes. Cost per commit: one atomic; a `fault` takes one vote.
///
/// A value is out of range if it is not finite, or if its magnitude is 2^(63-LogValues-Q) / scale or
/// more. Such a value is not added, and sets bit 0 of `*fault`. As long as `*fault` is 0, no sum of
/// fewer than 2^LogValues values has overflowed.
///
/// @snippet accumulate.cpp fixed
template <int Q, int LogValues = 25>
struct fixed {
    static_assert(Q >= -100 && Q <= 149, "fixed<Q> takes -100 <= Q <= 149");
    static_assert(LogValues >= 1 && LogValues <= 39, "fixed<Q, LogValues> takes 1 <= LogValues <= 39");
    static constexpr auto axis = warpagg::axis::accumulate;
    /// A member of every accumulate tag: see the namespace.
    /// @{
    using limb = std::int64_t;
    static constexpr int limbs = 1;
    using operation = warpagg::operation::sum;
    /// @}

    std::uint32_t* fault = nullptr;  ///< a flag in the device's memory; null to report no faults
    float scale = 1;                 ///< a power of two by which values are multiplied: see `scale_to_fit`

    /// Decomposes x into its limb, which is zero if x is out of range. Returns whether x is in range.
    WARPAGG_HD bool decompose(float x, limb (&to)[limbs]) const {
        const double units = static_cast<double>(x) * static_cast<double>(scale) * power_of_two(Q);
        const double room = power_of_two(63 - LogValues);
        const bool fits = parts_of_float(x).finite && units < room && units > -room;
        to[0] = fits ? static_cast<std::int64_t>(::llrint(units)) : 0;
        return fits;
    }
    /// Returns the sum of the scaled values. Divide it by `scale` to get the sum of the values.
    WARPAGG_HD static float value(const limb (&sum)[limbs]) {
        return static_cast<float>(static_cast<double>(sum[0]) * power_of_two(-Q));
    }

    /// Returns the largest scale from 2^-126 to 2^126 for which values with magnitudes up to
    /// |largest| are in range; 2^-126 if there is none, and 1 if `largest` is zero. Precondition:
    /// `largest` is finite.
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

/// Keeps the sum in K limbs, each the integer sum of one window of 24 bits of the values. Limb i holds
/// the highest window in use among those whose index is i modulo K. Error: at most
/// n 2^(24 (1-K)) max|x| + u |S|. The result has the same bits for any order of up to 2^31 additions
/// (`gpu_to_gpu`). Infinities and NaN add up as in IEEE 754. Memory per sum: 8 K bytes. Cost per
/// commit: K compare-and-swap loops. Source: indexed summation, Demmel and Nguyen 2015.
template <unsigned K>
struct binned {
    static_assert(K >= 2 && K <= 8, "binned<K> takes 2 <= K <= 8 windows");
    static constexpr auto axis = warpagg::axis::accumulate;
    using limb = std::uint64_t;  ///< upper 8 bits: index of a window, from 1; other bits: its signed sum
    /// A member of every accumulate tag: see the namespace.
    /// @{
    static constexpr int limbs = K;

    /// Keeps the limb of the higher window, or adds two limbs of the same window.
    struct operation : warpagg::operation::on_words<operation> {
        /// Combines two limbs: see `on_words`.
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
        const unsigned index = p.bit / window + 1;
        const std::uint64_t words[2] = {low == 0 ? 0 : word(index, p.negative ? 0 - low : low),
                                        high == 0 ? 0 : word(index + 1, p.negative ? 0 - high : high)};
        const std::uint64_t signs = (p.nan || !p.negative ? 1u : 0u) | (p.nan || p.negative ? 2u : 0u);
        WARPAGG_UNROLL
        for (unsigned k = 0; k < K; ++k) {  // constant indices keep the array in registers
            to[k] = index % K == k ? words[0] : (index + 1) % K == k ? words[1] : 0;
            if (!p.finite) to[k] = k == 0 ? word(infinite, signs) : 0;
        }
    }

    WARPAGG_HD static float value(const limb (&sum)[limbs]) {
        if (sum[0] >> 56 == infinite) return sum_of_infinities((sum[0] & 1u) != 0, (sum[0] & 2u) != 0);
        superaccumulator exact;
        for (const auto word : sum) {
            const std::uint64_t index = word >> 56;
            if (index == 0) continue;
            const std::int64_t signed_sum = static_cast<std::int64_t>(word << 8) >> 8;
            exact.add(signed_sum, static_cast<unsigned>(index - 1) * window);
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
    static constexpr unsigned window = 24;           // bits per window
    static constexpr std::uint64_t infinite = 0xff;  // index of infinities and NaN, above all windows
    WARPAGG_HD static std::uint64_t word(std::uint64_t index, std::uint64_t sum) {
        return index << 56 | (sum & 0xffffffffffffffu);
    }
};

/// Keeps the sum in a superaccumulator: nine limbs of 32 bits and their carries hold all bits that a
/// float can have, and a tenth limb counts infinities. The sum is rounded once. Error: at most half
/// an ulp. The result has the same bits for any order of up to 2^31 additions (`gpu_to_gpu`).
/// Infinities and NaN add up as in IEEE 754. Memory per sum: 80 bytes. Cost per commit: 10 atomics.
/// Source: Kulisch; Collange et al. 2015.
struct exact {
    static constexpr auto axis = warpagg::axis::accumulate;
    /// A member of every accumulate tag: see the namespace.
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
        for (int i = 0; i + 1 < limbs; ++i) {  // constant indices keep the array in registers
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

/// Reduces within the warp in float, as `native`; only the warp's result is accumulated in `A`.
/// Error: at most log2(W) u k plus the error of `A` for one value per warp with an active lane. The result
/// depends on which lanes share a warp, and on the order of warps if the result of `A` does. Cost:
/// the shuffles of `native`, and one decomposition per warp and component, not per lane and
/// component. `warp_reduce_atomic` accepts it, `warp_match_reduce_atomic` does not.
///
/// @snippet accumulate.cpp between_warps
template <class A>
struct between_warps : A {
    static_assert(
        requires { typename A::limb; } && !requires { typename A::storage; },
        "between_warps is of f64, compensated, fixed<Q>, binned<K> or exact");
    using storage = A;  ///< accumulate tag of the accumulators in memory
    /// @cond deprecated
    using kept [[deprecated("use storage")]] = storage;
    /// @endcond
};

}  // namespace accumulate

/// The storage of one sum in memory, for the accumulate tag `Accumulate`. All bytes zero is an empty
/// sum, so `cudaMemset` can clear arrays of accumulators.
template <class Accumulate>
struct accumulator {
    typename Accumulate::limb limb[Accumulate::limbs]{};  ///< the limbs: see `Accumulate`
    /// Returns the sum as a float.
    WARPAGG_HD float value() const { return Accumulate::value(limb); }
};

inline namespace tags {

/// A tag as an object, for `policy{...}`.
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

}  // namespace tags

/// @cond deprecated
template <class Accumulate>
using cell [[deprecated("use accumulator")]] = accumulator<Accumulate>;
/// @endcond

}  // namespace warpagg
