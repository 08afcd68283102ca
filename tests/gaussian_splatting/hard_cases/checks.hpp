// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "backend.hpp"

namespace hard_cases {

/// The index of the faulty Gaussian in a crowd.
inline constexpr std::size_t crowd = 30, victim = 15;

/// The values of one parameter of a Gaussian.
double* values_of(render_case& q, gs::parameter p, std::size_t i);

/// A photo of noise, for the gradients' sake.
void paint_photo(render_case& q, unsigned seed);

/// The quaternion of a turn about an axis.
std::array<double, 4> turned(double angle, const glm::dvec3& axis);

/// Checks each variant on each backend: `victim` is not drawn, and no other Gaussian changes.
void check_culled(const render_case& q);

/// With each variant on each backend: drawn as the reference draws, finite, and the image to 1e-3 of the
/// reference's; the gradients within the bounds if they are asked for.
void check_drawn(const render_case& q, bool with_gradients);

}  // namespace hard_cases
