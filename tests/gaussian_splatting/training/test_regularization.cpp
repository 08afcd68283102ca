// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <string>

#include "engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

TEST_CASE("quality: with few photos, dropout and the penalty on opacities make a better scene") {
    for (const auto make : engines()) {
        const auto mean_psnr = [&](double dropout, double penalty) {
            double sum = 0;
            for (const std::uint64_t seed : {0, 1, 2, 3}) {
                gs::load_options from;
                from.data = "synthetic:spheres,views=4,points=300";
                from.resolution = 48;
                from.eval = true;
                from.seed = seed;
                const gs::scene scene = gs::load_scene(from, {});
                const auto e = make();
                gs::train::train_options o;
                o.schedule.iterations = 1500;
                o.schedule.sh_degree = 0;
                o.schedule.dropout = dropout;
                o.densification.of<gs::train::adaptive_config>().opacity_penalty = penalty;
                o.max_cap = 4000;
                o.seed = seed;
                o.gradient = gs::accumulator::fixed;
                e->set_views(scene.train, scene.test, o.schedule.num_downscales);
                e->set_model(gs::from_points(scene.points, 0, 4000, seed));
                gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
                sum += gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
            }
            return sum / 4;
        };
        const double without = mean_psnr(0, 0), with_both = mean_psnr(0.05, 0.01);
        MESSAGE("without " << without << " dB, with both " << with_both << " dB");
        CHECK(with_both > without + 0.3);
    }
}
