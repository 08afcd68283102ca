// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_vignetting.hpp"

#include "../../scene/image_radius.hpp"

namespace gs {

std::array<double, 3> synthetic_falloff(const synthetic_parameters& how, const camera& camera, double x,
                                        double y) {
    const double u = square_radius(camera, x, y), shape = 0.5 * (u + u * u);
    return {1 - 0.9 * how.vignetting * shape, 1 - how.vignetting * shape, 1 - 1.1 * how.vignetting * shape};
}

}  // namespace gs
