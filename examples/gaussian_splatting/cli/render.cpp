// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../core/error.hpp"
#include "../evaluation/held_out_views.hpp"
#include "../poses/child_process.hpp"
#include "../scene/orbit.hpp"
#include "../video/camera_path.hpp"
#include "../video/video_file.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "stop_signals.hpp"

namespace gs::cli {

namespace {

struct named_camera {
    std::string name;
    gs::camera camera;
};

/// What `render` draws.
struct drawing {
    gaussians model;     ///< in internal coordinates
    bool alpha = false;  ///< whether the photos of the scene have transparent parts
    bool moves = false;  ///< whether the cameras are on an orbit or a path
    std::vector<named_camera> cameras{};
};

struct image_sides {
    int width, height;
};

/// Returns a size at --resolution, which divides it or is the longer side.
image_sides at_resolution(image_sides full, int resolution) {
    const double longer = std::max(full.width, full.height);
    const double scale = divides_size(resolution) ? 1.0 / resolution : resolution / longer;
    const auto scaled = [=](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
    return {scaled(full.width), scaled(full.height)};
}

/// Returns the size for cameras without one: square images, or the usual shape of videos.
image_sides default_sides(const settings& s) {
    return at_resolution(video::is_video(s.output) ? image_sides{1280, 720} : image_sides{800, 800},
                         s.scene.resolution);
}

/// Videos have even sides.
image_sides suited(const settings& s, image_sides sides) {
    if (!video::is_video(s.output)) return sides;
    return {std::max(2, sides.width / 2 * 2), std::max(2, sides.height / 2 * 2)};
}

/// Returns the cameras of a motion, numbered. `at`: the camera after a share of the frames.
template <class CameraAt>
std::vector<named_camera> moving_cameras(int frames, const CameraAt& at) {
    std::vector<named_camera> cameras;
    for (int i = 0; i < frames; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "%05d.png", i);
        cameras.push_back({name, at(i)});
    }
    return cameras;
}

/// Returns the number of frames of an orbit or a path.
int frame_count(const settings& s, std::optional<double> seconds_of_path) {
    constexpr double usual_seconds = 8, most_frames = 1e6;
    const double seconds = s.seconds.value_or(seconds_of_path.value_or(usual_seconds));
    const double frames = std::round(seconds * s.frames_per_second);
    if (frames > most_frames)
        throw error("--seconds " + std::to_string(seconds) + " is too long: lower it or --fps");
    return std::max(1, static_cast<int>(frames));
}

std::vector<named_camera> cameras_on(const orbit& around, const settings& s, image_sides sides) {
    const bool is_counted = !video::is_video(s.output) && !s.seconds;
    const int frames = is_counted ? s.orbit_views : frame_count(s, {});
    const image_sides size = suited(s, sides);
    return moving_cameras(frames, [&](int i) {
        return around.camera_at(static_cast<double>(i) / frames, size.width, size.height);
    });
}

std::vector<named_camera> cameras_on(const video::camera_path& path, const settings& s,
                                     const normalization& normalization) {
    const int frames = frame_count(s, path.seconds);
    image_sides size = default_sides(s);
    if (path.width && path.height) size = at_resolution({*path.width, *path.height}, s.scene.resolution);
    size = suited(s, size);
    return moving_cameras(frames, [&](int i) {
        const double share = frames > 1 ? static_cast<double>(i) / (frames - 1) : 0;
        return video::camera_of(path.at(share), normalization, size.width, size.height);
    });
}

std::vector<named_camera> cameras_of(const scene& scene) {
    const std::vector<view>& views = scene.test.empty() ? scene.train : scene.test;
    const auto names = evaluate::render_names(views);
    std::vector<named_camera> cameras;
    for (std::size_t i = 0; i < views.size(); ++i) cameras.push_back({names[i], views[i].camera});
    return cameras;
}

drawing drawing_of(gaussians model, const settings& s, const command_context& context) {
    std::optional<video::camera_path> path;
    if (!s.camera_path.empty()) path = video::read_camera_path(s.camera_path);
    drawing d;
    if (s.scene.data.empty()) {
        const normalization own = normalization_of(model);
        d.model = to_internal(own, std::move(model));
        d.moves = true;
        d.cameras = path ? cameras_on(*path, s, own) : cameras_on(orbit_of(d.model), s, default_sides(s));
        return d;
    }
    const scene scene = context.load();
    d.model = to_internal(scene.normalization, std::move(model));
    d.alpha = scene.has_alpha;
    d.moves = path || s.orbit;
    if (path) {
        d.cameras = cameras_on(*path, s, scene.normalization);
    } else if (s.orbit) {
        const camera& first = scene.train.front().camera;
        d.cameras = cameras_on(orbit_of(scene), s, {first.width, first.height});
    } else {
        d.cameras = cameras_of(scene);
    }
    return d;
}

void write_images(const settings& s, train::engine& engine, const drawing& d,
                  const std::array<float, 3>& background) {
    const output_folder output(s.output);
    for (const named_camera& c : d.cameras)
        write_png(output.path() / c.name, c.camera.width, c.camera.height,
                  engine.render(c.camera, background));
}

void write_movie(const settings& s, train::engine& engine, const drawing& d,
                 const std::array<float, 3>& background) {
    const std::filesystem::path file = s.output;
    const output_folder folder(file.has_parent_path() ? file.parent_path() : ".");
    const camera& first = d.cameras.front().camera;
    std::size_t next = 0;
    try {
        video::write_video(file, {first.width, first.height, s.frames_per_second}, [&] {
            if (next == d.cameras.size()) return std::vector<std::uint8_t>{};
            return interleaved(engine.render(d.cameras[next++].camera, background));
        });
    } catch (const poses::interrupted& e) {
        throw interruption(e.signal, e.what());
    }
}

/// Checks that the options about orbits and paths have an effect.
void check_motion(const settings& s) {
    const bool is_video = video::is_video(s.output);
    const bool moves = s.scene.data.empty() || s.orbit || !s.camera_path.empty();
    for (const char* key : {"seconds", "fps"})
        if (s.given.contains(key) && !moves)
            throw error(std::string("--") + key +
                        " beside --data needs --orbit or --path: add one of them or leave it out");
    if (s.given.contains("fps") && !is_video && s.camera_path.empty() && !s.seconds)
        throw error("--fps with images on an orbit needs --seconds: add it or leave out --fps");
    if (s.given.contains("orbit_views") && is_video)
        throw error("--orbit-views is for images: give --seconds for a video");
}

}  // namespace

void render(const settings& s) {
    check_motion(s);
    const command_context context(s);
    const bool is_video = video::is_video(s.output);
    if (is_video) video::require_encoder();
    const auto engine = context.make_engine();
    gaussians model = read_model(s.ply);
    context.require_no_background_before(model);
    if (model.count() == 0) throw error(s.ply + " holds no Gaussians: there is nothing to draw");
    const drawing d = drawing_of(std::move(model), s, context);
    if (is_video && !d.moves)
        throw error(
            "a video of the views of a scene jumps between them: add --orbit or --path, or give a "
            "folder with -o");
    const auto background = context.background(d.alpha);
    engine->set_model(d.model);
    if (is_video)
        write_movie(s, *engine, d, background.color);
    else
        write_images(s, *engine, d, background.color);
    context.say(std::to_string(d.cameras.size()) + (is_video ? " frames in " : " images in ") + s.output);
}

}  // namespace gs::cli
