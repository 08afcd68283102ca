// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "readers/load_scene.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

}  // namespace

TEST_CASE("long: masks: an object that passes in front of the cameras leaves no trace") {
    const gs::scene truth = small_scene("synthetic:spheres", 48);
    for (const auto make : engines()) {
        const auto psnr_of = [&](const char* data, bool masks) {
            gs::load_options from;
            from.data = data;
            from.resolution = 48;
            from.eval = true;
            from.masks = masks;
            gs::scene scene = gs::load_scene(from, {});
            scene.test = truth.test;
            for (std::size_t v = 0; v < scene.train.size(); v += 4)  // and some without
                scene.train[v] = truth.train[v];
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 600;
            o.schedule.sh_degree = 0;
            o.max_cap = 4000;
            e->set_views(scene.train, scene.test, o.schedule.num_downscales);
            e->set_model(gs::from_points(scene.points, 0, 3000, 1));
            gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
            return gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
        };
        const double clean = psnr_of("synthetic:spheres", true);
        const double masked = psnr_of("synthetic:spheres,passers=0.25", true);
        const double spoilt = psnr_of("synthetic:spheres,passers=0.25", false);
        CHECK(masked > clean - 2);  // which has a quarter more to learn from
        CHECK(masked > spoilt + 1);
    }
}
