// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../model/opacity.hpp"
#include "strategy.hpp"

namespace gs::train {

/// Makes Gaussians transparent that are closer to a training camera than its near plane. That camera
/// cannot see them, so its image does not remove them, and they would appear as floaters in other
/// views. One index per Gaussian.
struct hide_near_camera {
    const glm::vec3* cameras;
    std::size_t camera_count;
    const float* mean;
    float* opacity;
    float hidden;  ///< logit of the largest opacity of a hidden Gaussian

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

/// Runs `hide_near_camera` on the Gaussians of this rank.
template <device::device Device>
void hide_near_cameras(const trained_gaussians<Device>& g) {
    const auto values = g.parameters.values.write();
    g.device.for_each_index(
        g.own, hide_near_camera{g.cameras, g.camera_count, values.mean, values.opacity, logit(0)});
}

}  // namespace gs::train
