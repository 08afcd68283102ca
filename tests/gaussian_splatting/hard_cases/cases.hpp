// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <string>

#include "backend.hpp"

namespace hard_cases {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Parameters are floats, as the trainer's are: every device takes the same numbers.

/// A crowd of Gaussians before a camera, some of them half out of the image, with a random photo behind.
render_case random_case(unsigned seed, std::size_t splats, int width, int height, int sh_degree);

/// Random colors, one a pixel, behind all.
void add_background_image(render_case& q, unsigned seed);

/// The camera gets a fisheye lens of 160 degrees across and stands between the Gaussians.
void take_fisheye(render_case& q, unsigned seed);

/// The camera takes a panorama and stands between the Gaussians.
void take_panorama(render_case& q);

/// A pinhole camera, a fisheye lens or a panorama, by the seed.
void take_some_lens(render_case& q, unsigned seed);

/// Inverse depths in the loss, by random weights of either sign.
void add_depths(render_case& q, unsigned seed);

/// No Gaussians yet, degree 0, black background and photo, before a camera at the origin that looks along z,
/// with the focal length of the image's width and its axis through the middle of the image.
render_case empty_case(int width, int height);

/// A Gaussian of degree 0. The quaternion is w x y z.
struct gaussian {
    glm::dvec3 mean{0, 0, 4};
    glm::dvec3 log_scale{-1};
    std::array<double, 4> quaternion{1, 0, 0, 0};
    double opacity = 0;  ///< logit
    glm::dvec3 color{1};
};
void add(render_case& q, const gaussian& g);

/// The case without one of its Gaussians.
render_case without(const render_case& q, std::size_t index);

/// Moves the colors that lie within 1e-5 of black, where float and double may hold them or not, a thousandth
/// away. Returns how many.
std::size_t move_off_black(render_case& q);

/// The logit of an opacity, in double.
double logit_of(double opacity);

inline const std::array<std::string, gs::parameter_count> parameter_names{
    "mean", "log_scale", "quaternion", "opacity", "sh0", "sh1", "sh2", "sh3"};

}  // namespace hard_cases
