// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens.hpp"

namespace gs {

glm::dvec2 lens::distort(glm::dvec2 ray) const {
    const double u = ray.x, v = ray.y, r2 = u * u + v * v;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u),
            v * radial + 2 * p2 * u * v + p1 * (r2 + 2 * v * v)};
}

double lens::area_scale(glm::dvec2 ray) const {
    const double u = ray.x, v = ray.y, r2 = u * u + v * v;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = k1 + r2 * (2 * k2 + 3 * k3 * r2);  // d radial / d r2
    const double u_by_u = radial + 2 * u * u * slope + 2 * p1 * v + 6 * p2 * u;
    const double v_by_v = radial + 2 * v * v * slope + 2 * p2 * u + 6 * p1 * v;
    const double across = 2 * u * v * slope + 2 * p1 * u + 2 * p2 * v;
    return u_by_u * v_by_v - across * across;
}

}  // namespace gs
