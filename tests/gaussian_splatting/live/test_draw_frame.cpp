// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "image/image.hpp"
#include "live/draw_frame.hpp"
#include "scene/look_at.hpp"
#include "training/initialize.hpp"

namespace {

using gs::live::frame_artist;
using gs::live::overlay;
using gs::live::picture;
using gs::live::view_request;

constexpr std::array<float, 3> black{};

/// A white Gaussian, and one view of it whose photo is its render.
struct white_scene {
    std::unique_ptr<gs::train::engine> engine = gs::train::make_cpu_engine();
    std::vector<gs::view> views{1};

    white_scene() {
        const std::vector<gs::colored_point> points{{{0, 0, 0}, {255, 255, 255}}};
        gs::gaussians model = gs::from_points(points, 0, 1, 1);
        model.opacity = {4};
        model.log_scale = {-1, -1, -1};
        engine->set_model(model);
        gs::view& v = views[0];
        v.camera = gs::look_at({0, -3, 0}, {0, 0, 0}, {0, 0, 1}, 64, 60);
        v.camera.height = 32;
        v.camera.cy = 16;
        v.pixels = {64, 32, std::vector<std::uint8_t>(std::size_t{4} * 64 * 32, 255), false, false};
        const auto rgb = gs::interleaved(engine->render(v.camera, black));
        for (std::size_t i = 0; i < rgb.size(); ++i) v.pixels.rgba[4 * (i / 3) + i % 3] = rgb[i];
    }
    picture draw(overlay what, int width = 64, int height = 64) const {
        view_request request;
        request.width = width;
        request.height = height;
        request.overlay = what;
        request.view = 0;
        return frame_artist(*engine, views, black).draw(request);
    }
};

/// The sum of the channels at a pixel.
int light(const picture& p, int x, int y) {
    const auto at = static_cast<std::size_t>(3 * (y * p.width + x));
    return p.rgb[at] + p.rgb[at + 1] + p.rgb[at + 2];
}

}  // namespace

TEST_CASE("frames: a training view keeps its shape and is not enlarged") {
    const white_scene s;
    for (const auto& [width, height, expected] :
         {std::array{64, 64, 64}, {2048, 2048, 64}, {32, 2048, 32}, {2048, 16, 32}}) {
        const picture p = s.draw(overlay::none, width, height);
        CHECK(p.width == expected);
        CHECK(p.height == expected / 2);
        CHECK(p.rgb.size() == static_cast<std::size_t>(3 * p.width * p.height));
        CHECK(light(p, p.width / 2, p.height / 2) > 700);
    }
}

TEST_CASE("frames: errors are bright where the render differs from the photo, and masked pixels are dark") {
    white_scene s;
    const int dark = light(s.draw(overlay::error), 0, 0);
    const picture same = s.draw(overlay::error);
    for (int y = 0; y < same.height; ++y)
        for (int x = 0; x < same.width; ++x) CHECK(light(same, x, y) < 60);

    gs::image& photo = s.views[0].pixels;
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{1}}) photo.rgba[4 * pixel] = 200;
    photo.mask_pixel(1);
    const picture wrong = s.draw(overlay::error);
    CHECK(light(wrong, 0, 0) > 500);
    CHECK(light(wrong, 1, 0) == dark);
    CHECK(light(wrong, 40, 20) == light(same, 40, 20));
}

TEST_CASE("frames: depth is bright where something is near") {
    const white_scene s;
    const picture p = s.draw(overlay::depth);
    CHECK(light(p, 32, 16) > 500);
    CHECK(light(p, 0, 0) < 20);
}

TEST_CASE("frames: a free camera has the size and the field of view of the request") {
    view_request request;
    request.width = 50;
    request.height = 20;
    request.position = {0, -3, 0};
    request.forward = {0, 7, 0};
    request.up = {0, 0, 1};
    request.field_of_view = 1;
    const gs::camera c = gs::live::camera_of(request);
    CHECK(c.width == 50);
    CHECK(c.height == 20);
    const auto center = c.see({0, 0, 0}), top = c.see({0, 0, 3 * std::tan(0.5)});
    CHECK(center->x == doctest::Approx(25));
    CHECK(center->y == doctest::Approx(10));
    CHECK(top->y == doctest::Approx(0).scale(1));
}
