// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace gs {

/// Returns the number of SH coefficients per color channel up to a degree, including the constant
/// one.
constexpr int sh_coefficients(int degree) { return (degree + 1) * (degree + 1); }

/// The SH degree of a learned background, which lies infinitely far behind all Gaussians.
inline constexpr int sky_degree = 3;
inline constexpr std::size_t sky_width = 3 * sh_coefficients(sky_degree);

/// A model of 3D Gaussians on the host, in the parameterization of Kerbl et al. 2023, section 5.
/// Each parameter has one array of `count * width` floats, Gaussian by Gaussian.
struct gaussians {
    int sh_degree = 0;               ///< SH degree of `sh_rest`, 0 to 3
    bool antialiased = false;        ///< whether to render with antialiasing: see `effect_set`
    std::vector<float> sky;          ///< learned background: `sky_width` coefficients, or empty
    std::vector<float> mean;         ///< width 3: position
    std::vector<float> log_scale;    ///< width 3: log of standard deviations on principal axes
    std::vector<float> quaternion;   ///< width 4: w x y z, of any length but zero
    std::vector<float> opacity;      ///< width 1: logit
    std::vector<float> sh_constant;  ///< width 3: RGB of the coefficient of degree 0
    std::vector<float> sh_rest;      ///< width 3 * (sh_coefficients - 1): RGB of other coefficients

    std::size_t count() const { return opacity.size(); }
    int rest_width() const { return 3 * (sh_coefficients(sh_degree) - 1); }
};

}  // namespace gs
