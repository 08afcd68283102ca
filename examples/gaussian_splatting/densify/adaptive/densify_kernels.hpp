// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../device/atomic.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../../core/bits.hpp"
#include "../../render/project/geometry.hpp"
#include "../../render/project/project_backward.hpp"
#include "../../features/sh_degree/sh_error.hpp"
#include "densify_config.hpp"
#include "../../core/random.hpp"

namespace gs::train {

/// What a densification came to.
struct densify_tally {
    std::uint64_t count;        ///< of the new generation
    unsigned long long silent;  ///< those drawn whose centres took no gradient
};

/// How a Gaussian came to be in the new generation.
enum birth : std::uint32_t { kept, original, copy, split };

/// Who stays, who wants to grow, and who would do it by splitting: one index a Gaussian.
struct judge_gaussians {
    parameter_arrays<const float> gaussians;
    const raster::visibility* seen;
    densify_rule rule;
    std::uint32_t* stays;    ///< 1 or 0
    std::uint32_t* large;    ///< 1 or 0
    std::uint32_t* urgency;  ///< sort key: the more urgent the growth the smaller; all ones for none
    std::uint32_t* identities;
    unsigned long long* silent;  ///< those drawn whose centres took no gradient, added to

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        const raster::visibility v = seen[i];
        const float mean = v.seen > 0 ? v.gradient / v.seen : 0.0f;
        if (v.seen > 0 && v.gradient == 0) device::atomic_add(silent, 1);
        const glm::vec3 s = raster::load3(gaussians.log_scale, i);
        const float largest = glm::exp(warpagg::math::max(s.x, warpagg::math::max(s.y, s.z)));
        const bool stay = sigmoid(gaussians.opacity[i]) >= rule.least_opacity;
        stays[i] = stay ? 1 : 0;
        large[i] = largest > rule.dense_scale ? 1 : 0;
        identities[i] = i;
        // Positive floats sort as their bits do; the complement turns the order round.
        urgency[i] = stay && mean >= rule.gradient ? ~raster::bits_of(mean) : 0xffffffffu;
    }
};

/// The most urgent that there is room for become two: one index a rank.
struct let_grow {
    const std::uint32_t* urgency;
    const std::uint32_t* gaussian_of;
    const std::uint64_t* staying;  ///< how many
    std::uint64_t cap;
    std::uint64_t most_births;
    std::uint32_t* copies;

    WARPAGG_HD void operator()(std::size_t rank) const {
        if (*staying + rank < cap && rank < most_births && urgency[rank] != 0xffffffffu)
            copies[gaussian_of[rank]] = 2;
    }
};

/// How much each Gaussian matters to the views that saw it: one index a Gaussian. All stay, so far.
struct rate_gaussians {
    const raster::visibility* seen;
    std::uint32_t* stays;
    std::uint32_t* rating;  ///< sort key: the less it matters the smaller
    std::uint32_t* identities;

    WARPAGG_HD void operator()(std::size_t i) const {
        stays[i] = 1;
        rating[i] = raster::bits_of(seen[i].gradient);  // not negative: sorts as its bits do
        identities[i] = static_cast<std::uint32_t>(i);
    }
};

/// One index a rank.
struct drop_ranked {
    const std::uint32_t* gaussian_of;
    std::uint32_t* copies;

    WARPAGG_HD void operator()(std::size_t rank) const { copies[gaussian_of[rank]] = 0; }
};

/// How much it shows that a Gaussian has bands: one index a Gaussian. All keep them, so far.
struct rate_bands {
    const colour_spread* spreads;
    std::uint32_t* keeps;
    std::uint32_t* rating;  ///< sort key: the less it shows the smaller
    std::uint32_t* identities;

    WARPAGG_HD void operator()(std::size_t i) const {
        keeps[i] = 1;
        rating[i] = spreads[i].squares > 0 ? raster::bits_of(spreads[i].squares) : 0;
        identities[i] = static_cast<std::uint32_t>(i);
    }
};

/// A Gaussian that loses its bands gets its mean colour, if it was seen: one index a Gaussian.
struct take_mean_colour {
    const colour_spread* spreads;
    const std::uint32_t* keeps;
    float* sh0;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (keeps[i] != 0 || !(spreads[i].weight > 0)) return;
        for (std::size_t c = 0; c < 3; ++c) sh0[place(i, c, 3)] = sh_from_colour(spreads[i].mean[c]);
    }
};

/// Puts Gaussians that keep their bands before those that do not, both in their order: one index a Gaussian.
struct place_banded_first {
    std::size_t count;
    const std::uint32_t* keeps;
    const std::uint64_t* first;  ///< how many before it keep them
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint64_t at = keeps[i] != 0 ? first[i] : first[count] + (i - first[i]);
        origin[at] = static_cast<std::uint32_t>(i);
        births[at] = kept;
    }
};

/// Where each new Gaussian comes from: one index an old one.
struct place_copies {
    const std::uint32_t* copies;
    const std::uint32_t* large;
    const std::uint64_t* first;
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        for (std::uint32_t c = 0; c < copies[i]; ++c) {
            origin[first[i] + c] = static_cast<std::uint32_t>(i);
            births[first[i] + c] = copies[i] == 1 ? kept : large[i] != 0 ? split : c == 0 ? original : copy;
        }
    }
};

/// Carries values and moments of one parameter over to the new Gaussians, in whole blocks: one index a new
/// value. New ones begin without momentum.
struct carry_over {
    std::size_t count;   ///< of new Gaussians that have the parameter: the first ones
    std::size_t before;  ///< of old ones; the others' is zero
    const std::uint32_t* origin;
    const birth* births;
    std::size_t width;
    const float* from[3];
    float* to[3];

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t gaussian = i / (block_length * width) * block_length + i % block_length;
        const bool exists = gaussian < count && origin[gaussian] < before,
                   keeps = exists && (births[gaussian] == kept || births[gaussian] == original);
        const std::size_t source =
            exists ? place(origin[gaussian], i / block_length % width, width) : std::size_t{0};
        to[0][i] = exists ? from[0][source] : 0;
        to[1][i] = keeps ? from[1][source] : 0;
        to[2][i] = keeps ? from[2][source] : 0;
    }
};

/// The step that each new Gaussian took part in last is its origin's: one index a new Gaussian.
struct carry_steps {
    const std::uint32_t* origin;
    const std::uint32_t* from;
    std::uint32_t* to;

    WARPAGG_HD void operator()(std::size_t i) const { to[i] = from[origin[i]]; }
};

/// Both halves of a split draw a place from their parent's distribution and are 1.6 times smaller: one index
/// a new Gaussian.
struct part_halves {
    const birth* births;
    std::uint64_t seed;
    std::uint64_t step;
    parameter_arrays<float> gaussians;

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        if (births[i] != split) return;
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

/// Makes each of two copies as opaque as leaves both together what their original was: one index a new
/// Gaussian.
struct revise_opacity {
    const birth* births;
    float* opacity;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (births[i] != original && births[i] != copy) return;
        // Of 1 - sqrt(1 - o) the logit: with e = o / (1 - o), log(sqrt(1 + e) - 1) without its cancellation.
        const float e = glm::exp(warpagg::math::min(opacity[i], 80.0f));
        opacity[i] -= glm::log(1 + warpagg::math::sqrt(1 + e));
    }
};

/// Brings every opacity down to at most `most` (a logit) and forgets its momentum.
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

/// Hides what lies within the near plane's distance of a camera: one index a Gaussian.
struct hide_near_cameras {
    const glm::vec3* cameras;
    std::size_t camera_count;
    const float* mean;
    float* opacity;
    float hidden;  ///< a logit

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        const glm::vec3 at = raster::load3(mean, i);
        constexpr auto near = static_cast<float>(raster::near_plane);
        bool is_near = false;
        for (std::size_t c = 0; c < camera_count; ++c) {
            const glm::vec3 offset = at - cameras[c];
            is_near = is_near || glm::dot(offset, offset) < near * near;
        }
        if (is_near) opacity[i] = warpagg::math::min(opacity[i], hidden);
    }
};

}  // namespace gs::train
