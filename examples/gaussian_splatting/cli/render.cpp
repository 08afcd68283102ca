// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "../core/error.hpp"
#include "../evaluation/held_out_views.hpp"
#include "../scene/look_at.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"

namespace gs::cli {

namespace {

struct named_camera {
    std::string name;
    gs::camera camera;
};

/// Returns cameras on a circle around the center of the Gaussians, slightly above the plane of
/// their largest extent. Precondition: the model is normalized by its own normalization: see
/// `normalization_of`.
std::vector<named_camera> orbit(const gaussians& model, int views, int size) {
    const std::size_t n = model.count();
    std::array<glm::dvec3, 2> quartiles;  // of the means; robust against floaters
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = model.mean[3 * i + static_cast<std::size_t>(axis)];
        std::ranges::sort(x);
        quartiles[0][axis] = x[n / 4];
        quartiles[1][axis] = x[n - 1 - n / 4];
    }
    const glm::dvec3 middle = 0.5 * (quartiles[0] + quartiles[1]), spread = quartiles[1] - quartiles[0];
    const int thin = spread.x < spread.y ? (spread.x < spread.z ? 0 : 2) : (spread.y < spread.z ? 1 : 2);
    glm::dvec3 up(0), ahead(0);
    up[thin] = 1;
    ahead[(thin + 1) % 3] = 1;
    const glm::dvec3 side = glm::cross(up, ahead);
    const double radius = 2.5 * std::max(glm::length(spread), 1.0);
    std::vector<named_camera> cameras;
    for (int i = 0; i < views; ++i) {
        const double a = 2 * std::acos(-1.0) * i / views;
        const glm::dvec3 from =
            middle + radius * (0.9 * (std::cos(a) * ahead + std::sin(a) * side) + 0.45 * up);
        char name[32];
        std::snprintf(name, sizeof name, "%05d.png", i);
        cameras.push_back({name, look_at(from, middle, up, size, 1.2 * size)});
    }
    return cameras;
}

std::vector<named_camera> cameras_of(const scene& scene) {
    const std::vector<view>& views = scene.test.empty() ? scene.train : scene.test;
    const auto names = evaluate::render_names(views);
    std::vector<named_camera> cameras;
    for (std::size_t i = 0; i < views.size(); ++i) cameras.push_back({names[i], views[i].camera});
    return cameras;
}

/// Returns the side of an orbit's images, in pixels. A small --resolution divides 800 pixels; a
/// larger one is the side itself.
int orbit_size(int resolution) { return divides_size(resolution) ? 800 / resolution : resolution; }

}  // namespace

void render(const settings& s) {
    const command_context context(s);
    const auto engine = context.make_engine();
    gaussians model = read_model(s.ply);
    context.require_no_background_before(model);
    if (model.count() == 0) throw error(s.ply + " holds no Gaussians: there is nothing to draw");
    const bool orbits = s.scene.data.empty();
    bool alpha = false;
    std::vector<named_camera> cameras;
    if (orbits) {
        const normalization own = normalization_of(model);
        model = to_internal(own, std::move(model));
        cameras = orbit(model, s.orbit_views, orbit_size(s.scene.resolution));
    } else {
        const scene scene = context.load();
        model = to_internal(scene.normalization, std::move(model));
        alpha = scene.has_alpha;
        cameras = cameras_of(scene);
    }
    const auto background = context.background(alpha);
    const output_folder output(s.output);
    engine->set_model(model);
    for (const named_camera& c : cameras)
        write_png(output.path() / c.name, c.camera.width, c.camera.height,
                  engine->render(c.camera, background.color));
    context.say(std::to_string(cameras.size()) + " images in " + s.output);
}

}  // namespace gs::cli
