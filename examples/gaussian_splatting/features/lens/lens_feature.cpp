// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_feature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../text.hpp"

namespace gs::features {

finding lens_feature::analyze(const scene_statistics& statistics) const {
    std::size_t photos = 0;
    double widest = 0;  // largest angle from corner to corner, in degrees
    for (const view& v : statistics.scene().train) {
        const camera& c = v.camera;
        if (!c.fisheye) continue;
        ++photos;
        const double corner =
            std::hypot(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
        widest = std::max(widest, 360 / std::numbers::pi * c.fisheye->angle(corner));
    }
    if (photos == 0)
        return {false, "all cameras are pinhole cameras, or their photos were undistorted", "pinhole"};
    return {true,
            text("%zu of %zu photos have fisheye lenses with diagonals of up to %.0f degrees", photos,
                 statistics.scene().train.size(), widest),
            "fisheye"};
}

}  // namespace gs::features
