// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "../core/error.hpp"
#include "../evaluation/held_out_views.hpp"
#include "../scene/orbit.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"

namespace gs::cli {

namespace {

struct named_camera {
    std::string name;
    gs::camera camera;
};

std::vector<named_camera> cameras_on(const orbit& around, int views, int size) {
    std::vector<named_camera> cameras;
    for (int i = 0; i < views; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "%05d.png", i);
        cameras.push_back({name, around.camera_at(static_cast<double>(i) / views, size, size)});
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
        cameras = cameras_on(orbit_of(model), s.orbit_views, orbit_size(s.scene.resolution));
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
