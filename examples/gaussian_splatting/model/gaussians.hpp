// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace gs {

/// Number of spherical harmonics coefficients a color channel has at a degree, the constant one included.
constexpr int sh_coefficients(int degree) { return (degree + 1) * (degree + 1); }

/// A sky, what lies infinitely far behind all Gaussians, has spherical harmonics of this degree.
inline constexpr int sky_degree = 3;
inline constexpr std::size_t sky_width = 3 * sh_coefficients(sky_degree);

/// A cloud of 3D Gaussians on the host, in the standard parameterisation (Kerbl et al. 2023, section 5).
/// One array a parameter, Gaussian-major: `count * width` floats.
struct gaussians {
    int sh_degree = 0;               ///< 0 to 3: what `sh_rest` has room for
    bool antialiased = false;        ///< to be drawn as `effect_set::antialiasing` says
    std::vector<float> sky;          ///< `sky_width`: coefficient-major, RGB within; or no sky
    std::vector<float> mean;         ///< 3: world position
    std::vector<float> log_scale;    ///< 3: log of the standard deviations along the principal axes
    std::vector<float> quaternion;   ///< 4: w x y z, of any length but zero
    std::vector<float> opacity;      ///< 1: logit
    std::vector<float> sh_constant;  ///< 3: RGB, the degree 0 coefficient
    std::vector<float> sh_rest;      ///< 3 * (sh_coefficients - 1): coefficient-major, RGB within

    std::size_t count() const { return opacity.size(); }
    int rest_width() const { return 3 * (sh_coefficients(sh_degree) - 1); }
};

}  // namespace gs
