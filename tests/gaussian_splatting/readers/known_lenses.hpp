// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "colmap_model.hpp"

namespace gs_test {

/// A camera of COLMAP, and its distortion as COLMAP's documentation describes it.
struct distorted_case {
    camera_record camera;
    std::function<glm::dvec2(glm::dvec2)> distort;
};

inline distorted_case simple_radial(double k) {
    return {{1, 2, "SIMPLE_RADIAL", 160, 120, {130, 83, 57, k}},
            [k](glm::dvec2 p) { return p * (1 + k * glm::dot(p, p)); }};
}

inline distorted_case radial(double k1, double k2) {
    return {{1, 3, "RADIAL", 160, 120, {130, 83, 57, k1, k2}}, [k1, k2](glm::dvec2 p) {
                const double r2 = glm::dot(p, p);
                return p * (1 + k1 * r2 + k2 * r2 * r2);
            }};
}

inline distorted_case opencv(double k1, double k2, double p1, double p2) {
    return {{1, 4, "OPENCV", 160, 120, {130, 110, 83, 57, k1, k2, p1, p2}}, [=](glm::dvec2 p) {
                const double r2 = glm::dot(p, p), xy = p.x * p.y;
                const glm::dvec2 tangential(2 * p1 * xy + p2 * (r2 + 2 * p.x * p.x),
                                            p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * xy);
                return p * (1 + k1 * r2 + k2 * r2 * r2) + tangential;
            }};
}

inline gs::camera intrinsics_of(const camera_record& record) {
    const auto& p = record.parameters;
    gs::camera result;
    result.width = static_cast<int>(record.width);
    result.height = static_cast<int>(record.height);
    const bool two = record.model == "OPENCV";
    result.fx = p[0];
    result.fy = p[two ? 1 : 0];
    result.cx = p[two ? 2 : 1];
    result.cy = p[two ? 3 : 2];
    return result;
}

}  // namespace gs_test
