// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/bits.hpp"
#include "../../core/random.hpp"
#include "../../device/atomic.hpp"
#include "../../model/opacity.hpp"
#include "../../render/project/geometry.hpp"
#include "../../render/project/project_backward.hpp"
#include "../parameter_gather.hpp"
#include "densify_config.hpp"

namespace gs::train {

/// Counts of one densification.
struct densify_tally {
    std::uint64_t count;                  ///< number of Gaussians in the new generation
    unsigned long long without_gradient;  ///< number of drawn Gaussians without gradient
};

/// Classifies each Gaussian: whether it stays, whether it is large, and how urgently it should
/// grow. One index per Gaussian.
struct classify {
    parameter_arrays<const float> gaussians;
    const raster::visibility* seen;
    densify_config config;
    std::uint32_t* stays;    ///< 1 or 0
    std::uint32_t* large;    ///< 1 if it grows by a split, otherwise 0
    std::uint32_t* urgency;  ///< sort key, smaller if more urgent; all bits set: no growth
    std::uint32_t* identities;
    unsigned long long* without_gradient;  ///< counter of drawn Gaussians without gradient

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        const raster::visibility v = seen[i];
        const float mean = v.seen > 0 ? v.gradient / v.seen : 0.0f;
        if (v.seen > 0 && v.gradient == 0) device::atomic_add(without_gradient, 1);
        const glm::vec3 s = raster::load3(gaussians.log_scale, i);
        const float largest = glm::exp(warpagg::math::max(s.x, warpagg::math::max(s.y, s.z)));
        const bool stay = sigmoid(gaussians.opacity[i]) >= config.least_opacity;
        stays[i] = stay ? 1 : 0;
        large[i] = largest > config.dense_scale ? 1 : 0;
        identities[i] = i;
        // Positive floats have the same order as their bits; the complement reverses it.
        urgency[i] = stay && mean >= config.gradient ? ~raster::bits_of(mean) : 0xffffffffu;
    }
};

/// Selects the most urgent Gaussians for growth, as many as `cap` and `most_births` allow: each
/// becomes two. One index per rank.
struct select_growth {
    const std::uint32_t* urgency;
    const std::uint32_t* gaussian_of;
    const std::uint64_t* staying;  ///< number of Gaussians that stay
    std::uint64_t cap;
    std::uint64_t most_births;
    std::uint32_t* copies;

    WARPAGG_HD void operator()(std::size_t rank) const {
        if (*staying + rank < cap && rank < most_births && urgency[rank] != 0xffffffffu)
            copies[gaussian_of[rank]] = 2;
    }
};

/// Rates Gaussians by the sum of their gradients, and marks all of them to stay. One index per
/// Gaussian.
struct rate_by_gradient {
    const raster::visibility* seen;
    std::uint32_t* stays;
    std::uint32_t* rating;  ///< sort key, which increases with the gradient
    std::uint32_t* identities;

    WARPAGG_HD void operator()(std::size_t i) const {
        stays[i] = 1;
        rating[i] = raster::bits_of(seen[i].gradient);  // bits have the order of floats
        identities[i] = static_cast<std::uint32_t>(i);
    }
};

/// Writes the origin and birth of each new Gaussian. One index per old Gaussian.
struct place_copies {
    const std::uint32_t* copies;
    const std::uint32_t* large;
    const std::uint64_t* first;
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        for (std::uint32_t c = 0; c < copies[i]; ++c) {
            origin[first[i] + c] = static_cast<std::uint32_t>(i);
            births[first[i] + c] = copies[i] == 1  ? birth::kept
                                   : large[i] != 0 ? birth::half
                                   : c == 0        ? birth::original
                                                   : birth::copy;
        }
    }
};

/// Gives both halves of a split a random position from the distribution of their origin, and
/// divides their scale by 1.6. One index per new Gaussian.
struct split {
    const birth* births;
    std::uint64_t seed;
    std::uint64_t step;
    parameter_arrays<float> gaussians;

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        if (births[i] != birth::half) return;
        const glm::vec3 log_scale = raster::load3(gaussians.log_scale, i);
        const raster::unit turn(raster::load4(gaussians.quaternion, i));
        counter_random random(seed, step, i);
        const glm::vec3 offset =
            raster::rotation_of(turn.direction) * (glm::exp(log_scale) * random.normal3());
        const glm::vec3 mean = raster::load3(gaussians.mean, i) + offset;
        if (raster::is_finite(mean)) raster::store3(gaussians.mean, i, mean);
        raster::store3(gaussians.log_scale, i, log_scale - glm::vec3(0.47000363f));  // log 1.6
    }
};

/// Gives a cloned Gaussian and its clone the opacity with which both together are as opaque as the
/// Gaussian was. One index per new Gaussian.
struct revise_opacity {
    const birth* births;
    float* opacity;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (births[i] != birth::original && births[i] != birth::copy) return;
        // The logit of 1 - sqrt(1 - o) is log(sqrt(1 + e) - 1) with e = o / (1 - o). This form
        // avoids the cancellation.
        const float e = glm::exp(warpagg::math::min(opacity[i], 80.0f));
        opacity[i] -= glm::log(1 + warpagg::math::sqrt(1 + e));
    }
};

/// Lowers each opacity to at most `most`, a logit, and clears its moments. One index per Gaussian.
struct lower_opacity {
    float* opacity;
    float* first;
    float* second;
    float most;

    WARPAGG_HD void operator()(std::size_t i) const {
        opacity[i] = warpagg::math::min(opacity[i], most);
        first[i] = 0;
        second[i] = 0;
    }
};

}  // namespace gs::train
