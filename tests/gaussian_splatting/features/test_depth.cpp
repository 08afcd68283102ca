// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/depth/depth_agreement.hpp"
#include "features/resolve.hpp"
#include "losses/inverse_depth/depth_gradient.hpp"
#include "readers/load_scene.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

std::vector<float> flattened_fits(const std::vector<gs::depth_fit>& fits) {
    std::vector<float> values;
    for (const gs::depth_fit& fit : fits) values.insert(values.end(), {fit.scale, fit.offset});
    return values;
}

}  // namespace

TEST_CASE("an inverse depth is drawn to what its map says, and to nothing that it does not know") {
    const std::vector<float> drawn{0.2f, 0.4f, 0.3f, 0.3f, 0.1f};
    const std::vector<std::uint16_t> map{100, 100, 100, 0, 1};  // 0.3, and below zero
    std::vector<float> gradient(15, 7.0f);
    const gs::train::depth_gradient kernel{drawn.data(), map.data(), {0.004f, -0.1f},
                                           0.5f,         5,          gradient.data()};
    for (std::size_t i = 0; i < 5; ++i) kernel(i);
    CHECK(gradient[0] == -0.5f);
    CHECK(gradient[1] == 0.5f);
    CHECK(std::abs(gradient[2]) <= 0.5f);
    CHECK(gradient[3] == 0);
    CHECK(gradient[4] == 0.5f);
    for (std::size_t i = 5; i < 15; ++i) CHECK(gradient[i] == 0);
}

TEST_CASE("quality: with depth maps, few photos with few points make a better scene") {
    for (const auto make : engines()) {
        double gain = 0;
        for (const std::uint64_t seed : {0, 1, 2, 3}) {
            gs::load_options from;
            from.data = "synthetic:spheres,views=4,points=300,depths=0.02";
            from.resolution = 48;
            from.eval = true;
            from.seed = seed;
            const gs::scene scene = gs::load_scene(from, {});
            const auto psnr_with = [&](const std::vector<gs::depth_fit>& fits) {
                const auto e = make();
                gs::train::train_options o;
                o.schedule.iterations = 1500;
                o.schedule.sh_degree = 0;
                o.max_cap = 4000;
                o.seed = seed;
                o.gradient = gs::accumulator::fixed;  // the same whenever it is run: runs differ by a dB
                // Regularization corrects much of what depth maps correct.
                o.schedule.dropout = 0;
                o.densification.of<gs::train::adaptive_config>().opacity_penalty = 0;
                if (!fits.empty()) o.features = feature_set({{"depth", true, "", flattened_fits(fits)}});
                e->set_views(scene.train, scene.test, o.schedule.num_downscales);
                e->set_model(gs::from_points(scene.points, 0, 4000, seed));
                gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
                return gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
            };
            const depth_agreement found = compare_depths(scene);
            CHECK(found.agreeing >= 3);
            gain += psnr_with(found.fits) / 4 - psnr_with({}) / 4;
        }
        MESSAGE("depth maps bring " << gain << " dB");
        CHECK(gain > 0.1);
    }
}
