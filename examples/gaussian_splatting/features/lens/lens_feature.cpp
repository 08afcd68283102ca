// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_feature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../text.hpp"

namespace gs::features {

finding lens_feature::analyze(const scene_statistics& statistics) const {
    std::size_t photos = 0, panoramas = 0;
    double widest = 0;  // largest angle from corner to corner, in degrees
    for (const view& v : statistics.scene().train) {
        const camera& c = v.camera;
        if (c.is_panorama) ++panoramas;
        if (!c.fisheye) continue;
        ++photos;
        const double corner =
            std::hypot(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
        widest = std::max(widest, 360 / std::numbers::pi * c.fisheye->angle(corner));
    }
    const std::size_t all = statistics.scene().train.size();
    const std::string with_fisheye = text(
        "%zu of %zu photos have fisheye lenses with diagonals of up to %.0f degrees", photos, all, widest);
    const std::string are_panoramas = text("%zu of %zu photos are panoramas", panoramas, all);
    if (photos > 0 && panoramas > 0)
        return {true, with_fisheye + ", and " + are_panoramas, "fisheye and panorama"};
    if (photos > 0) return {true, with_fisheye, "fisheye"};
    if (panoramas > 0) return {true, are_panoramas, "panorama"};
    return {false, "all cameras are pinhole cameras, or their photos were undistorted", "pinhole"};
}

}  // namespace gs::features
