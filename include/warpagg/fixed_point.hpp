// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Fixed-point sums of floats with one scale for a whole array. Integer sums do not depend on the
/// order of additions, so results have the same bits on every GPU and on the CPU (`gpu_to_gpu`).
/// Unlike the tag `accumulate::fixed`, the scale follows from the values: run `largest_exponent`
/// first.

#include "warp/concept.hpp"

namespace warpagg {

/// What `largest_exponent` finds in an array. All bytes zero describes an empty array.
struct magnitudes {
    unsigned exponent;    ///< largest biased exponent of the finite values
    unsigned not_finite;  ///< 1 if a value is infinite or NaN, and 0 otherwise
};

/// A fixed-point format for sums of floats or doubles. `limbs` integers of 64 bits hold a sum: one
/// for float, two for double.
template <class T>
struct fixed_point {
    static constexpr int limbs = sizeof(T) / 4;  ///< integers per sum

    T scale = 1;   ///< units of the first limb per one, a power of two
    int bits = 0;  ///< bits of the second limb below a unit of the first

    /// Returns how many bits of a limb one value may use, if a sum has up to `n` values.
    /// @param n  at most 2^32
    static constexpr WARPAGG_HD int bits_per_value(std::uint64_t n) {
        int log_n = 0;
        while (log_n < 32 && (std::uint64_t{1} << log_n) < n) ++log_n;
        return 62 - log_n;  // mutate: fixed_point_overflows
    }
    /// Returns the finest format that holds sums of values that use `bits_per_value` bits. A unit
    /// of its first limb is not below the smallest normal T, so a float's denormal values count as
    /// zero.
    /// @param exponent  largest biased exponent of the values, as `largest_exponent` finds it
    /// @param bits_per_value  result of the function of this name
    static WARPAGG_HD fixed_point of(unsigned exponent, int bits_per_value) {
        // The values are below 2^(exponent + 1 - bias).
        const int wanted = bits_per_value - (static_cast<int>(exponent) + 1 - bias);
        return {power_of_two<T>(wanted < bias - 1 ? wanted : bias - 1), bits_per_value};
    }

    /// Returns limb `i` of a value; 0 if the value is not finite. Error of all limbs together: at
    /// most half a unit of the last one.
    WARPAGG_HD std::int64_t limb(T x, int i) const {
        // The product is exact, except for values far below a unit.
        const T units = (is_finite(x) ? x : T{0}) * scale;
        const std::int64_t first = round(units);
        if (limbs == 1 || i == 0) return first;
        return round((units - static_cast<T>(first)) * power_of_two<T>(bits));
    }

    /// Returns a sum from the sums of its limbs, rounded to double.
    WARPAGG_HD double value(const std::int64_t (&sum)[limbs]) const {
        const double inverse = 1 / static_cast<double>(scale);
        const double high = static_cast<double>(sum[0]);
        if constexpr (limbs == 1) {
            return high * inverse;
        } else {
            const double rest = static_cast<double>(sum[0] - static_cast<std::int64_t>(high));
            const double low = static_cast<double>(sum[1]) / power_of_two<double>(bits);
            return (high + (rest + low)) * inverse;
        }
    }

    /// Returns the biased exponent of |x|, all ones if x is infinite or NaN.
    static WARPAGG_HD unsigned exponent(T x) {
        word w;
        std::memcpy(&w, &x, sizeof w);
        return static_cast<unsigned>(w >> significand) & exponent_mask;
    }
    /// Returns whether x is a number.
    static WARPAGG_HD bool is_finite(T x) { return exponent(x) != exponent_mask; }

  private:
    using word = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    static constexpr int significand = sizeof(T) == 8 ? 52 : 23, bias = sizeof(T) == 8 ? 1023 : 127;
    static constexpr unsigned exponent_mask = 2 * bias + 1;

    static WARPAGG_HD std::int64_t round(float x) { return ::llrintf(x); }
    static WARPAGG_HD std::int64_t round(double x) { return ::llrint(x); }
    template <class U>
    static WARPAGG_HD U power_of_two(int e) {
        if constexpr (sizeof(U) == 8) {
            const auto w = static_cast<std::uint64_t>(e + 1023) << 52;
            U power;
            std::memcpy(&power, &w, sizeof w);
            return power;
        } else {
            const auto w = static_cast<std::uint32_t>(e + 127) << 23;
            U power;
            std::memcpy(&power, &w, sizeof w);
            return power;
        }
    }
};

/// A kernel that finds the largest exponent of an array. Each warp reads every `warps`-th tile.
/// Cost: one read of the values, and few atomics. Requires a model whose value type is a scalar.
/// Preconditions: `values` is aligned to 16 bytes, and `*result` is zero before the first call.
template <class T>
struct largest_exponent {
    const T* values;     ///< `count` values
    std::size_t count;   ///< number of values
    magnitudes* result;  ///< receives the result

    static constexpr unsigned values_per_lane = 16;  ///< in a tile

    /// Returns the number of tiles for warps of `lanes` lanes.
    WARPAGG_HD std::size_t tiles(unsigned lanes) const {
        return count / (std::size_t{lanes} * values_per_lane) + 1;
    }

    /// Reads the tiles `index`, `index + warps`, and so on. All lanes of the warp call this
    /// together.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, std::size_t index, std::size_t warps) const {
        using math::max;
        magnitudes seen{};
        for (std::size_t tile = index; tile < tiles(W::size); tile += warps) {
            magnitudes mine = of_tile(w, tile);
            for (unsigned distance = W::size / 2; distance > 0; distance /= 2) {
                mine.exponent = max(mine.exponent, w.shfl_xor(mine.exponent, distance));
                mine.not_finite = max(mine.not_finite, w.shfl_xor(mine.not_finite, distance));
            }
            // A warp commits when its maximum grows, which is rare and does not delay the next
            // tile.
            commit(w, &result->exponent, mine.exponent, seen.exponent);
            commit(w, &result->not_finite, mine.not_finite, seen.not_finite);
        }
    }

  private:
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD magnitudes of_tile(const W& w, std::size_t tile) const {
        constexpr unsigned packs = values_per_lane / 4;
        const std::size_t first = tile * W::size * values_per_lane;
        T v[packs][4];
        WARPAGG_UNROLL
        for (unsigned p = 0; p < packs; ++p) {
            const unsigned at = (p * W::size + w.lane()) * 4;
            const std::size_t left = first + at < count ? count - first - at : 0;
            w.load_packed(values + first, at, v[p], left >= 4);
            if (left > 0 && left < 4) {
                for (unsigned k = 0; k < 3; ++k) v[p][k] = w.load(values + first, at + k, k < left);
            }
        }
        magnitudes found{};
        WARPAGG_UNROLL
        for (unsigned p = 0; p < packs; ++p) {
            WARPAGG_UNROLL
            for (unsigned k = 0; k < 4; ++k) {
                if (fixed_point<T>::is_finite(v[p][k]))
                    found.exponent = math::max(found.exponent, fixed_point<T>::exponent(v[p][k]));
                else
                    found.not_finite = 1;
            }
        }
        return found;
    }

    struct element {
        unsigned* address;
        WARPAGG_HD unsigned* operator()(unsigned i) const { return address + i; }
    };
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD static void commit(const W& w, unsigned* to, unsigned mine, unsigned& seen) {
        if (mine <= seen) return;
        seen = mine;
        w.atomic(operation::maximum{}, element{to}, 0u, mine, w.lane() == 0u);
    }
};

/// A conversion of values to summands, for `scatter_rows`: limb `limb` of the format for sums of up to
/// `n` values, of which `largest_exponent` found `*largest`.
template <class T>
struct to_fixed_point {
    const magnitudes* largest;  ///< result of `largest_exponent`
    int bits_per_value;         ///< see `fixed_point::bits_per_value`
    int limb;                   ///< number of the limb

    /// Describes limb `i` of sums of up to `n` values.
    WARPAGG_HD to_fixed_point(const magnitudes* all, std::uint64_t n, int i = 0)
        : largest(all), bits_per_value(fixed_point<T>::bits_per_value(n)), limb(i) {}

    /// The conversion.
    struct convert {
        fixed_point<T> format;  ///< the format that fits the values
        int limb;               ///< number of the limb
        /// Returns the limb of a value.
        WARPAGG_HD std::int64_t operator()(T x) const { return format.limb(x, limb); }
    };
    /// Returns the conversion.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD convert operator()(const W& w) const {
        return {fixed_point<T>::of(w.load(&largest->exponent, 0u, true), bits_per_value), limb};
    }
};

}  // namespace warpagg
