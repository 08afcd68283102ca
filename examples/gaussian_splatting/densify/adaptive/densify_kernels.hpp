// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../core/bits.hpp"
#include "../../device/atomic.hpp"
#include "../../model/opacity.hpp"
#include "../../render/project/geometry.hpp"
#include "../../render/project/project_backward.hpp"
#include "../growth/growth_kernels.hpp"
#include "densify_config.hpp"

namespace gs::train {

/// Classifies each Gaussian: whether it stays, whether it is large, and how urgently it should
/// grow. One index per Gaussian.
struct classify {
    parameter_arrays<const float> gaussians;
    const raster::visibility* seen;
    densify_config config;
    growth_marks marks;

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        const raster::visibility v = seen[i];
        const float mean = v.seen > 0 ? v.gradient / v.seen : 0.0f;
        if (v.seen > 0 && v.gradient == 0) device::atomic_add(marks.without_gradient, 1);
        const glm::vec3 s = raster::load3(gaussians.log_scale, i);
        const float largest = glm::exp(warpagg::math::max(s.x, warpagg::math::max(s.y, s.z)));
        const bool stay = sigmoid(gaussians.opacity[i]) >= config.least_opacity;
        marks.stays[i] = stay ? 1 : 0;
        marks.large[i] = largest > config.dense_scale ? 1 : 0;
        marks.identities[i] = i;
        // Positive floats have the same order as their bits; the complement reverses it.
        marks.key[i] = stay && mean >= config.gradient ? ~raster::bits_of(mean) : growth_marks::never;
    }
};

/// Rates Gaussians by the sum of their gradients, and marks all of them to stay. One index per
/// Gaussian.
struct rate_by_gradient {
    const raster::visibility* seen;
    growth_marks marks;

    WARPAGG_HD void operator()(std::size_t i) const {
        marks.stays[i] = 1;
        marks.key[i] = raster::bits_of(seen[i].gradient);  // bits have the order of floats
        marks.identities[i] = static_cast<std::uint32_t>(i);
    }
};

/// Lowers each opacity to at most `most`, a logit, and clears its moments. One index per Gaussian.
struct lower_opacity {
    float* opacity;
    moment_arrays moments;
    float most;

    WARPAGG_HD void operator()(std::size_t i) const {
        opacity[i] = warpagg::math::min(opacity[i], most);
        moments.clear(parameter::opacity, i);
    }
};

}  // namespace gs::train
