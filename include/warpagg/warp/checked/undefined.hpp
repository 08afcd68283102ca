// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Undefined values, which a lane reads from a lane that takes no part. For float and double they are
/// NaN whose bits encode their origin; for other types they are random bits.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "../../core/call_site.hpp"
#include "seeds.hpp"

namespace warpagg::emulator::detail {

struct undefined_read {
    call_site at;
    unsigned block, thread;
    unsigned from;  ///< the lane that was read
};

class undefined_values {
  public:
    /// Returns the undefined value for a read. `inverted` selects another value, made from the same
    /// random numbers.
    template <class T>
    T make(const undefined_read& read, random_source& random, bool inverted) {
        if (reads_.size() < most) reads_.push_back(read);
        const auto id = static_cast<std::uint32_t>(reads_.size() - 1);
        std::uint64_t words[(sizeof(T) + 7) / 8];
        for (auto& word : words) word = random.bits();
        T value;
        if constexpr (std::is_same_v<T, float>) {
            const std::uint32_t bits = quiet_nan | tag | id;
            std::memcpy(&value, &bits, sizeof value);
            if (inverted) value = static_cast<float>(static_cast<std::int64_t>(words[0] >> 32));
        } else if constexpr (std::is_same_v<T, double>) {
            const std::uint64_t bits = (std::uint64_t{0x7ff} << 52) | (std::uint64_t{half | tag | id} << 29);
            std::memcpy(&value, &bits, sizeof value);
            if (inverted) value = static_cast<double>(static_cast<std::int64_t>(words[0] >> 32));
        } else if constexpr (std::is_same_v<T, bool>) {
            value = ((words[0] & 1u) != 0) != inverted;
        } else {
            for (auto& word : words) word = inverted ? ~word : word;
            std::memcpy(static_cast<void*>(&value), words, sizeof value);
        }
        return value;
    }

    /// Returns the origin of `value` if it is such a NaN or computed from one, and null otherwise.
    template <class T>
    const undefined_read* origin(const T& value) const {
        std::uint32_t mantissa = 0;
        if constexpr (std::is_same_v<T, float>) {
            std::uint32_t bits;
            std::memcpy(&bits, &value, sizeof bits);
            if ((bits & infinity) != infinity) return nullptr;
            mantissa = bits & 0x7fffffu;
        } else if constexpr (std::is_same_v<T, double>) {
            std::uint64_t bits;
            std::memcpy(&bits, &value, sizeof bits);
            if (((bits >> 52) & 0x7ffu) != 0x7ffu) return nullptr;
            mantissa = static_cast<std::uint32_t>(bits >> 29) & 0x7fffffu;
        }
        const std::uint32_t id = mantissa & (most - 1);
        return (mantissa & ~(most - 1)) == (half | tag) && id < reads_.size() ? &reads_[id] : nullptr;
    }

    std::size_t count() const { return reads_.size(); }
    const undefined_read& last() const { return reads_.back(); }
    /// Returns the last of the first `n` reads that this thread made, or that any thread made if this
    /// thread made none. Precondition: n > 0.
    const undefined_read& last_of(std::size_t n, unsigned block, unsigned thread) const {
        for (std::size_t i = n; i-- > 0;)
            if (reads_[i].block == block && reads_[i].thread == thread) return reads_[i];
        return reads_[n - 1];
    }

  private:
    // The mantissa of a float holds the quiet bit, a tag of 10 bits, and the index of the read in 12
    // bits. The mantissa of a double begins with the same 23 bits, because conversions preserve them.
    static constexpr std::uint32_t infinity = 0x7f800000, half = 0x400000, quiet_nan = infinity | half;
    static constexpr std::uint32_t tag = 0x2b5u << 12, most = 1u << 12;

    std::vector<undefined_read> reads_;
};

}  // namespace warpagg::emulator::detail
