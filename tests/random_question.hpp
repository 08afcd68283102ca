// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "render_probe.hpp"

namespace probe {

/// A crowd of Gaussians before a camera, some of them half out of the picture, with a random photo behind.
inline question random_question(unsigned seed, std::size_t splats, int width, int height, int sh_degree) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    question q;
    q.sh_degree = sh_degree;
    q.background = {static_cast<float>(uniform(random)), static_cast<float>(uniform(random)),
                    static_cast<float>(uniform(random))};
    gs::camera& c = q.view.camera;
    c.width = width;
    c.height = height;
    c.fx = 1.1 * width;
    c.fy = 0.9 * width;
    c.cx = 0.47 * width;
    c.cy = 0.55 * height;
    const glm::dquat turn =
        glm::normalize(glm::dquat(1, 0.3 * normal(random), 0.3 * normal(random), 0.3 * normal(random)));
    c.rotation = glm::mat3_cast(turn);
    c.translation = glm::dvec3(0.1, -0.2, 4);

    for (std::size_t p = 0; p < gs::parameter_count; ++p)
        if (gs::has_parameter(p, sh_degree))
            q.parameters[p].resize(splats * static_cast<std::size_t>(gs::parameter_width[p]));
    for (std::size_t i = 0; i < splats; ++i) {
        for (std::size_t k = 0; k < 3; ++k) q.parameters[0][3 * i + k] = 1.2 * (2 * uniform(random) - 1);
        for (std::size_t k = 0; k < 3; ++k) q.parameters[1][3 * i + k] = -1.5 + 0.7 * normal(random);
        for (std::size_t k = 0; k < 4; ++k) q.parameters[2][4 * i + k] = normal(random);
        q.parameters[3][i] = 2 * normal(random);
    }
    for (std::size_t p = 4; p < gs::parameter_count; ++p)
        for (double& x : q.parameters[p]) x = (p == 4 ? 0.6 : 0.2) * normal(random);
    // The host's Gaussians are floats: every device is asked about the same numbers.
    for (auto& values : q.parameters)
        for (double& x : values) x = static_cast<float>(x);

    gs::image& photo = q.view.pixels;
    photo.width = width;
    photo.height = height;
    photo.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255);
    for (std::size_t i = 0; i < photo.rgba.size(); ++i)
        if (i % 4 != 3) photo.rgba[i] = static_cast<std::uint8_t>(random() % 256);
    return q;
}

}  // namespace probe
