// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "optimize/trained_parameters.hpp"
#include "render/project/shown_blocks.hpp"
#include "render/renderer.hpp"
#include "training/initialize.hpp"

namespace {

/// Small Gaussians all around the origin, in 63 whole blocks and a part of one.
gs::gaussians small_ones_around() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-4, 4);
    std::vector<gs::colored_point> points(63 * gs::block_length + 5);
    for (auto& p : points) p.position = {place(random), place(random), place(random)};
    gs::gaussians model = gs::from_points(points, 0, points.size(), 1);
    std::ranges::fill(model.log_scale, -6.0f);
    return model;
}

struct blocks {
    std::vector<std::uint32_t> shown, drawn;
};
blocks seen_by(const gs::camera& camera) {
    const gs::gaussians model = small_ones_around();
    gs::device::cpu device;
    gs::train::trained_parameters<gs::device::cpu> all;
    all.set_values(device, model);
    gs::raster::renderer<gs::device::cpu, float> renderer(device);
    renderer.reserve_instances(1u << 20);
    renderer.list(all.values.read(), model.count(), camera, 0);
    const std::size_t n = gs::in_whole_blocks(model.count()) / gs::block_length;
    blocks found{std::vector<std::uint32_t>(n, 7), std::vector<std::uint32_t>(n)};
    gs::raster::find_shown_blocks(device, all.values.read().mean, model.count(), camera, found.shown.data());
    for (std::size_t i = 0; i < model.count(); ++i)
        if (renderer.tiles_of()[i] != 0) found.drawn[i / gs::block_length] = 1;
    return found;
}

gs::camera turned(gs::camera c) {
    c.rotation = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.2, -0.4, 0.3)));
    c.translation = {0.3, -0.1, 0.7};
    return c;
}

}  // namespace

TEST_CASE("shown blocks: all blocks with small Gaussians that a view draws, for each lens") {
    gs::camera bent{200, 150, 70, 70, 97, 78};
    bent.fisheye = gs::fisheye({0.04, -0.012, 0.003, -0.0004});
    for (const gs::camera& camera :
         {gs::camera{200, 150, 180, 180, 97, 78}, bent, gs::camera::panorama(200, 100)}) {
        const blocks found = seen_by(turned(camera));
        std::size_t more = 0;
        for (std::size_t b = 0; b < found.shown.size(); ++b) {
            REQUIRE(found.shown[b] <= 1);
            CHECK(found.shown[b] >= found.drawn[b]);
            more += found.shown[b] - found.drawn[b];
        }
        CHECK(std::ranges::count(found.drawn, 1u) > 8);
        CHECK(more <= found.shown.size() / 5);
    }
}

TEST_CASE("shown blocks: a narrow view shows few blocks") {
    const blocks found = seen_by(turned({200, 150, 400, 400, 100, 75}));
    CHECK(std::ranges::count(found.shown, 1u) < 30);
}
