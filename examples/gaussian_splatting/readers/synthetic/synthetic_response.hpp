// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "synthetic_parameters.hpp"

namespace gs {

/// Returns the color that a photo shows for an exposed color, which is first clamped to [0, 1]. With the
/// strength s = `how.response`, this is (1 - s) x + s sin^2(pi x / 2), a curve with the shape of an S. It is
/// no polynomial, but polynomials of degree 5 come close to it.
double synthetic_response(const synthetic_parameters& how, double x);

}  // namespace gs
