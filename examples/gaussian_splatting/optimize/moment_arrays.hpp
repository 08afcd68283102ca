// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../core/bits.hpp"
#include "../core/counter_hash.hpp"
#include "../model/parameters.hpp"
#include "../render/geometry/vectors.hpp"
#include "moment_precision.hpp"

namespace gs::train {

/// Two moments in a word. `Bits` and `Real` are the types of 32-bit unsigned integers and floats of a warp.
template <class Real, class Bits>
struct moment_pair {
    Real first, second;

    static WARPAGG_HD moment_pair unpack(const Bits& word) {
        return {raster::bits_of<Real>(word & Bits(0xffff0000u)), raster::bits_of<Real>(word << Bits(16u))};
    }
    /// Precondition: the moments are finite.
    WARPAGG_HD Bits pack(const Bits& random) const {
        const Bits one = raster::bits_of<Bits>(first) + (random & Bits(0xffffu)),
                   two = raster::bits_of<Bits>(second) + (random >> Bits(16u));
        return (one & Bits(0xffff0000u)) | (two >> Bits(16u));
    }
};

/// The first moments of three color channels in a word, relative to the root of their second moment.
template <class Real, class Bits>
struct color_moments {
    /// First moments are at most 12.6 times the root of the second moment, by the Cauchy-Schwarz
    /// inequality for the weights of Adam's means and three channels.
    static constexpr float unit = 12.75f / 511;
    static constexpr unsigned bits = 10, half = 1u << (bits - 1), most = (1u << bits) - 1;

    Real relative[3];

    static WARPAGG_HD color_moments unpack(const Bits& word) {
        color_moments m;
        WARPAGG_UNROLL
        for (unsigned n = 0; n < 3; ++n) {
            const Bits biased = ((word >> Bits(bits * n)) & Bits(most)) ^ Bits(half);
            m.relative[n] =
                (warpagg::math::convert<float>(biased) - Real(static_cast<float>(half))) * Real(unit);
        }
        return m;
    }
    WARPAGG_HD Bits pack(const Bits& random) const {
        Bits word(0u);
        WARPAGG_UNROLL
        for (unsigned n = 0; n < 3; ++n) {
            const Real up = warpagg::math::convert<float>((random >> Bits(bits * n)) & Bits(most)) *
                            Real(1.0f / static_cast<float>(most + 1));
            const Real biased = relative[n] * Real(1 / unit) + Real(static_cast<float>(half)) + up;
            const Real inside = warpagg::math::max(
                Real(0.0f), warpagg::math::min(Real(static_cast<float>(most)), biased));  // also for NaN
            const Bits field = warpagg::math::convert<std::uint32_t>(inside) ^ Bits(half);
            word |= field << Bits(bits * n);
        }
        return word;
    }
};

/// Adam's moments of all parameters, in one of two forms.
struct moment_arrays {
    parameter_arrays<float> first, second;   ///< null if the moments are compact
    parameter_arrays<std::uint32_t> packed;  ///< null if they are not

    WARPAGG_HD bool are_compact() const { return packed.mean != nullptr; }
    /// Returns the second moment of an element of a parameter that is no SH coefficient.
    WARPAGG_HD float second_of(parameter p, std::size_t element) const {
        return are_compact() ? raster::bits_of<float>(packed[p][element] << 16) : second[p][element];
    }
    /// Sets the moments of such an element to zero.
    WARPAGG_HD void clear(parameter p, std::size_t element) const {
        if (are_compact()) {
            packed[p][element] = 0;
        } else {
            first[p][element] = second[p][element] = 0;
        }
    }
};

}  // namespace gs::train
