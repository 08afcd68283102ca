// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/math.hpp"

namespace warpagg::accumulate {

/// The parts of a float: (-1)^negative significand 2^(bit - 149), or an infinity or NaN.
struct parts_of_float {
    std::uint32_t significand;  ///< below 2^24
    unsigned bit;               ///< 0 to 253: weight 2^(bit - 149) of the significand's lowest bit
    bool negative;              ///< the sign bit
    bool finite;                ///< if false, only `nan` and `negative` have a meaning
    bool nan;                   ///< whether the float is NaN

    /// Takes any float apart into its fields.
    WARPAGG_HD explicit parts_of_float(float x) {
        std::uint32_t bits;
        std::memcpy(&bits, &x, sizeof bits);
        const std::uint32_t exponent = (bits >> 23) & 0xffu, fraction = bits & 0x7fffffu;
        negative = (bits >> 31) != 0;
        finite = exponent != 0xffu;
        nan = !finite && fraction != 0;
        significand = exponent == 0 ? fraction : fraction | 0x800000u;
        bit = exponent == 0 ? 0u : exponent - 1;
    }
};

/// A signed integer in units of 2^-149, the smallest positive float. Limb i has the weight 2^(32 i). Source:
/// Kulisch.
struct superaccumulator {
    static constexpr unsigned count = 12;  ///< enough for the 277 bits of floats and the carries above them
    std::int64_t limb[count]{};            ///< signed limbs, whose carries need not be propagated

    /// Adds value 2^bit. Preconditions: |value| < 2^62, bit <= 32 (count - 3), and fewer than 2^29 additions.
    WARPAGG_HD void add(std::int64_t value, unsigned bit) {
        const bool negative = value < 0;
        const auto magnitude = static_cast<std::uint64_t>(negative ? -value : value);
        const unsigned first = bit / 32, shift = bit % 32;
        const std::uint64_t low = (magnitude & 0xffffffffu) << shift, high = (magnitude >> 32) << shift;
        const std::uint64_t part[3] = {low & 0xffffffffu, (low >> 32) + (high & 0xffffffffu), high >> 32};
        for (unsigned i = 0; i < 3; ++i) {
            const auto signed_part = static_cast<std::int64_t>(part[i]);
            limb[first + i] += negative ? -signed_part : signed_part;
        }
    }

    /// Returns the nearest float, ties to even. Returns an infinity beyond the largest float.
    WARPAGG_HD float nearest() const {
        std::uint32_t digit[count];
        const bool negative = digits(digit, 1);
        if (negative) digits(digit, -1);
        unsigned top = count;
        while (top > 0 && digit[top - 1] == 0) --top;
        if (top == 0) return 0.0f;
        unsigned width = 32 * (top - 1);  // bits in use
        for (std::uint32_t d = digit[top - 1]; d != 0; d >>= 1) ++width;
        const auto bit = [&](unsigned at) { return (digit[at / 32] >> (at % 32)) & 1u; };
        const unsigned drop = width > 24 ? width - 24 : 0;
        std::uint32_t significand = 0;
        for (unsigned at = width; at-- > drop;) significand = significand << 1 | bit(at);
        if (drop > 0 && bit(drop - 1) != 0) {
            bool odd_or_more = (significand & 1u) != 0;
            for (unsigned at = 0; at + 1 < drop; ++at) odd_or_more = odd_or_more || bit(at) != 0;
            if (odd_or_more) ++significand;  // a carry to 2^24 increments the exponent below
        }
        // The highest bit of a significand of 24 bits adds 1 to the exponent field, which must be
        // drop + 1 for such a significand.
        std::uint32_t bits = (drop << 23) + significand;
        if (drop > 253) bits = 0x7f800000u;
        bits |= negative ? 0x80000000u : 0u;
        float result;
        std::memcpy(&result, &bits, sizeof result);
        return result;
    }

  private:
    /// Writes the digits of `sign` times this integer to base 2^32. Returns whether the product is negative.
    /// The digits of a negative product are its two's complement.
    WARPAGG_HD bool digits(std::uint32_t (&digit)[count], std::int64_t sign) const {
        std::int64_t carry = 0;
        for (unsigned i = 0; i < count; ++i) {
            const std::int64_t sum = sign * limb[i] + carry;
            digit[i] = static_cast<std::uint32_t>(sum);
            carry = sum >> 32;
        }
        return carry < 0;
    }
};

/// Returns the sum of infinities of the given signs. NaN counts as one infinity of each sign.
WARPAGG_HD float sum_of_infinities(bool positive, bool negative) {
    const std::uint32_t bits = positive && negative ? 0x7fc00000u : positive ? 0x7f800000u : 0xff800000u;
    float result;
    std::memcpy(&result, &bits, sizeof result);
    return result;
}

}  // namespace warpagg::accumulate
