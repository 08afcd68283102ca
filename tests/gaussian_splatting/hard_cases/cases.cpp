// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "cases.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "model/spherical_harmonics.hpp"

namespace hard_cases {

void add_background_image(render_case& q, unsigned seed) {
    std::mt19937 random(seed);
    q.background_image.resize(3 * q.pixels());
    for (double& x : q.background_image) x = static_cast<double>(random() % 1000) / 999;
}

void take_fisheye(render_case& q, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    gs::camera& c = q.view.camera;
    c.fisheye = gs::fisheye(
        {0.03 * normal(random), 0.01 * normal(random), 0.002 * normal(random), 0.0003 * normal(random)});
    c.fx = 0.36 * c.width;
    c.fy = 0.33 * c.width;
    c.translation = glm::dvec3(0.1, -0.2, 1);
}

void take_panorama(render_case& q) {
    gs::camera c = gs::camera::panorama(q.view.camera.width, q.view.camera.height);
    c.rotation = q.view.camera.rotation;
    c.translation = glm::dvec3(0.1, -0.2, 0.3);
    q.view.camera = c;
}

void take_some_lens(render_case& q, unsigned seed) {
    const unsigned kind = seed / 16 % 4;
    if (kind == 1 || (kind == 3 && seed % 2 == 0)) take_fisheye(q, seed);
    if (kind == 2 || (kind == 3 && seed % 2 == 1)) take_panorama(q);
}

void add_depths(render_case& q, unsigned seed) {
    std::mt19937 random(seed);
    q.depth_weights.resize(q.pixels());
    for (double& x : q.depth_weights)
        x = static_cast<float>((static_cast<double>(random() % 2001) / 1000 - 1) /
                               static_cast<double>(q.pixels()));
}

render_case random_case(unsigned seed, std::size_t splats, int width, int height, int sh_degree) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    render_case q;
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
    for (auto& values : q.parameters)
        for (double& x : values) x = static_cast<float>(x);

    gs::image& photo = q.view.pixels;
    photo.width = width;
    photo.height = height;
    photo.rgba.resize(4 * q.pixels(), 255);
    for (std::size_t i = 0; i < photo.rgba.size(); ++i)
        if (i % 4 != 3) photo.rgba[i] = static_cast<std::uint8_t>(random() % 256);
    return q;
}

render_case empty_case(int width, int height) {
    render_case q;
    q.sh_degree = 0;
    q.view.camera.width = width;
    q.view.camera.height = height;
    q.view.camera.fx = q.view.camera.fy = width;
    q.view.camera.cx = 0.5 * width;
    q.view.camera.cy = 0.5 * height;
    q.view.pixels.width = width;
    q.view.pixels.height = height;
    q.view.pixels.rgba.assign(4 * q.pixels(), 0);
    for (std::size_t i = 3; i < q.view.pixels.rgba.size(); i += 4) q.view.pixels.rgba[i] = 255;
    return q;
}

void add(render_case& q, const gaussian& g) {
    const auto append = [&](gs::parameter p, const auto& values, int n) {
        for (int k = 0; k < n; ++k) {
            const double x = values[static_cast<std::size_t>(k)];
            q.parameters[static_cast<std::size_t>(p)].push_back(static_cast<float>(x));
        }
    };
    const auto array = [](const glm::dvec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
    append(gs::parameter::mean, array(g.mean), 3);
    append(gs::parameter::log_scale, array(g.log_scale), 3);
    append(gs::parameter::quaternion, g.quaternion, 4);
    append(gs::parameter::opacity, std::array<double, 1>{g.opacity}, 1);
    double first_harmonic[1];
    gs::sh_basis(0, glm::dvec3(0, 0, 1), first_harmonic);
    append(gs::parameter::sh0, array((g.color - 0.5) / first_harmonic[0]), 3);
}

render_case without(const render_case& q, std::size_t index) {
    render_case rest = q;
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        if (rest.parameters[p].empty()) continue;
        const auto width = static_cast<std::size_t>(gs::parameter_width[p]);
        const auto from = rest.parameters[p].begin() + static_cast<std::ptrdiff_t>(index * width);
        rest.parameters[p].erase(from, from + static_cast<std::ptrdiff_t>(width));
    }
    return rest;
}

std::size_t move_off_black(render_case& q) {
    std::size_t moved = 0;
    const glm::dvec3 center = q.view.camera.center();
    for (std::size_t i = 0; i < q.count(); ++i) {
        const double* mean = q.parameters[0].data() + 3 * i;
        double basis[16];
        gs::sh_basis(q.sh_degree, glm::normalize(glm::dvec3(mean[0], mean[1], mean[2]) - center), basis);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double color = 0.5;
            for (std::size_t band = 0, k = 0; band <= static_cast<std::size_t>(q.sh_degree); ++band) {
                const std::size_t size = 2 * band + 1;
                for (std::size_t m = 0; m < size; ++m, ++k)
                    color += basis[k] * q.parameters[4 + band][(i * size + m) * 3 + channel];
            }
            if (std::abs(color) > 1e-5) continue;
            double& constant = q.parameters[4][3 * i + channel];
            constant = static_cast<float>(constant + 1e-3);
            ++moved;
        }
    }
    return moved;
}

double logit_of(double opacity) { return std::log(opacity / (1 - opacity)); }

}  // namespace hard_cases
