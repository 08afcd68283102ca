// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/bits.hpp"
#include "../../model/opacity.hpp"
#include "../../render/project/geometry.hpp"
#include "../parameter_gather.hpp"

namespace gs::train {

/// Counts of one change of generation.
struct growth_tally {
    std::uint64_t count;                  ///< number of Gaussians in the new generation
    unsigned long long without_gradient;  ///< number of drawn Gaussians without gradient
};

/// What a strategy decides for each Gaussian. All arrays are in device memory.
struct growth_marks {
    static constexpr std::uint32_t never = 0xffffffffu;

    std::uint32_t* stays;                  ///< 1 if the Gaussian stays, otherwise 0
    std::uint32_t* large;                  ///< 1 if it grows by a split, 0 if it is cloned
    std::uint32_t* key;                    ///< sort key: the smallest grow, or are removed, first; or `never`
    std::uint32_t* identities;             ///< the index of the Gaussian
    unsigned long long* without_gradient;  ///< counter of drawn Gaussians without gradient
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
        if (*staying + rank < cap && rank < most_births && urgency[rank] != growth_marks::never)
            copies[gaussian_of[rank]] = 2;
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

/// Places the halves of a split on the longest axis of their origin, half a standard deviation to
/// each side. They are half as long, a little thinner, and less opaque (Deng et al. 2025,
/// "ImprovedGS"). One index per new Gaussian; the halves of a split are neighbors.
struct split {
    const birth* births;
    const std::uint32_t* origin;
    parameter_arrays<float> gaussians;

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        if (births[i] != birth::half) return;
        const bool is_second = i > 0 && origin[i - 1] == origin[i];
        glm::vec3 log_scale = raster::load3(gaussians.log_scale, i);
        const int axis = longest(log_scale);
        const raster::unit turn(raster::load4(gaussians.quaternion, i));
        const float distance = (is_second ? 0.5f : -0.5f) * glm::exp(log_scale[axis]);
        const glm::vec3 mean =
            raster::load3(gaussians.mean, i) + distance * raster::rotation_of(turn.direction)[axis];
        if (raster::is_finite(mean)) raster::store3(gaussians.mean, i, mean);
        constexpr float log_half = -0.6931472f, log_thinner = -0.1625189f;  // log 0.85
        for (int k = 0; k < 3; ++k) log_scale[k] += k == axis ? log_half : log_thinner;
        raster::store3(gaussians.log_scale, i, log_scale);
        // The logit of 0.6 o is log(0.6) + l - log(1 + 0.4 e^l), with the logit l of o.
        const float opacity = warpagg::math::min(gaussians.opacity[i], 80.0f);
        gaussians.opacity[i] = opacity - 0.5108256f - glm::log(1 + 0.4f * glm::exp(opacity));
    }

  private:
    WARPAGG_HD static int longest(const glm::vec3& v) {
        return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2;
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

}  // namespace gs::train
