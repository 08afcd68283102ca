// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "../../scene/camera.hpp"
#include "synthetic_parameters.hpp"

namespace gs {

/// Returns the factors on displayed red, green and blue by which the lens darkens a place of the image, in
/// pixels. With the squared distance u from the principal point relative to the farthest corner, a factor is
/// 1 - s (u + u^2) / 2. Green has the strength s = `how.vignetting`, red 0.9 and blue 1.1 times this.
std::array<double, 3> synthetic_falloff(const synthetic_parameters& how, const camera& camera, double x,
                                        double y);

}  // namespace gs
