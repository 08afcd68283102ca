// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "motion_values.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "../poses/pose_change.hpp"

namespace gs::features {

std::vector<motion_scale> motion_scales(const scene& scene) {
    std::vector<motion_scale> scales;
    for (const given_pose& pose : given_poses(scene))
        scales.push_back({pose.depth, 1 / std::sqrt(pose.camera.fx * pose.camera.fy)});
    return scales;
}

camera_motion motion_of(const motion_scale& scale, const motion_values& values) {
    if (!std::ranges::all_of(values, [](float x) { return std::isfinite(x); })) return {};
    const glm::dvec3 turn = scale.angle * glm::dvec3(values[0], values[1], values[2]);
    const glm::dvec3 shift = shift_unit * scale.angle * glm::dvec3(values[3], values[4], values[5]);
    return {turn + glm::dvec3(shift.y, -shift.x, 0) / scale.depth, shift, 1,
            readout_unit * static_cast<double>(values[6])};
}

glm::dvec2 blur_of(const camera& camera, const camera_motion& motion, double depth) {
    const glm::dvec3 velocity = glm::cross(motion.turn, glm::dvec3(0, 0, 1)) + motion.shift / depth;
    return motion.exposure * glm::dvec2(camera.fx * velocity.x, camera.fy * velocity.y);
}

void share_readout(std::vector<float>& values) {
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < values.size(); i += motion_width) {
        float* row = &values[i];
        if (row[6] < 0)
            for (std::size_t k = 0; k < motion_width; ++k) row[k] = -row[k];
        double square = 0;
        for (std::size_t k = 0; k < 6; ++k) square += std::pow(static_cast<double>(row[k]), 2);
        sum += square * static_cast<double>(row[6]);
        weights += square;
    }
    if (!(weights > 0) || !std::isfinite(sum)) return;
    for (std::size_t i = 0; i < values.size(); i += motion_width)
        values[i + 6] = static_cast<float>(sum / weights);
}

}  // namespace gs::features
