// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/exponential.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <warpagg/warp/concept.hpp>

namespace gs::train {

/// Counter-based random numbers. Seed, step and index determine them, independent of the device and
/// of the order of calls. Source: the finalizer of SplitMix64 (Steele et al. 2014).
struct counter_random {
    std::uint64_t state;

    WARPAGG_HD counter_random(std::uint64_t seed, std::uint64_t step, std::uint64_t index)
        : state(mix(mix(mix(seed) ^ step) ^ index)) {}

    WARPAGG_HD float uniform() {  ///< Returns the next uniform number in (0, 1)
        state += 0x9e3779b97f4a7c15u;
        return (static_cast<float>(mix(state) >> 41) + 0.5f) * 0x1p-23f;
    }
    /// Returns the next whole number below `limit`, which is far below 2^64.
    WARPAGG_HD std::uint64_t below(std::uint64_t limit) {
        state += 0x9e3779b97f4a7c15u;
        return mix(state) % limit;
    }
    /// Returns three independent standard normal numbers. Source: Box and Muller 1958.
    WARPAGG_HD glm::vec3 normal3() {
        const float r = warpagg::math::sqrt(-2 * glm::log(uniform())), a = 6.2831853f * uniform();
        const float s = warpagg::math::sqrt(-2 * glm::log(uniform())), b = 6.2831853f * uniform();
        return {r * glm::cos(a), r * glm::sin(a), s * glm::cos(b)};
    }

  private:
    static WARPAGG_HD std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
};

}  // namespace gs::train
