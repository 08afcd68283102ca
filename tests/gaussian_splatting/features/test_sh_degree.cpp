// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <random>
#include <vector>

#include "../training/engines.hpp"
#include "engine/sh_degree_state.hpp"
#include "features/sh_degree/revise_sh_degree.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

}  // namespace

TEST_CASE("bands go, with their memory, where training is told so, and come as zeros") {
    const gs::scene scene = small_scene();
    for (const auto make : engines())
        for (const int degree : {0, 1, 2, 3}) {
            CAPTURE(degree);
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 40;
            o.schedule.sh_degree = 2;
            o.schedule.sh_degree_interval = 5;
            o.schedule.sh_lr = 1e-9;
            o.max_cap = 4000;
            e->set_views(scene.train, {}, o.schedule.num_downscales);
            gs::gaussians model = gs::from_points(scene.points, 2, 3000, 1);
            std::ranges::fill(model.sh_rest, 0.01f);
            e->set_model(model);
            const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
            gs::train::training training(*e, scene, o, quiet);
            int reviews = 0;
            schedule_revision(training,
                              [&](int sh_degree) {
                                  ++reviews;
                                  CHECK(sh_degree == 2);
                                  return degree;
                              },
                              {});
            training.run();
            CHECK(training.schedule().sh_degree == degree);
            CHECK(reviews == 1);
            const gs::gaussians after = e->get_model();
            CHECK(after.sh_degree == degree);
            const auto rest = static_cast<std::size_t>(after.rest_width());
            REQUIRE(after.sh_rest.size() == rest * e->count());
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < after.sh_rest.size(); ++i)
                wrong += std::abs(after.sh_rest[i] - (i % rest < 24 ? 0.01f : 0.0f)) > 1e-5f;
            CHECK(wrong == 0);
        }
}

TEST_CASE("long: sh_degree: the revision adds degrees that images need, and drops invisible ones") {
    for (const auto make : engines())
        for (const char* name : {"synthetic:spheres,gloss=0.8", "synthetic:spheres,noise=0.1"}) {
            CAPTURE(name);
            const bool glossy = std::string(name).find("gloss") != std::string::npos;
            const gs::scene scene = small_scene(name, 64);
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 300;
            o.schedule.sh_degree = 0;
            o.max_cap = 2000;
            e->set_views(scene.train, {}, o.schedule.num_downscales);
            e->set_model(gs::from_points(scene.points, 0, 2000, 1));
            const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
            gs::train::train(*e, scene, o, quiet);
            const show_function as_rendered = o.features.show_on_host(*e, scene);
            const sh_review left = revise_sh_degree(*e, scene, as_rendered, {}, 0);
            CHECK((glossy ? left.sh_degree >= 2 : left.sh_degree == 0));
            CHECK_FALSE(left.change);
            CHECK(left.unexplained[0] > 0);
            if (glossy) continue;
            dynamic_cast<gs::train::sh_degree_state&>(e->feature("direction")).set_degree(2);
            CHECK(revise_sh_degree(*e, scene, as_rendered, {}, 2).sh_degree == 0);
            gs::gaussians model = e->get_model();
            for (std::size_t i = 0; i < model.sh_rest.size(); ++i)
                if (i % 24 < 9) model.sh_rest[i] = 0.02f;  // the band of degree 1
            e->set_model(model);
            const sh_review kept = revise_sh_degree(*e, scene, as_rendered, {}, 2);
            CHECK(kept.sh_degree == 1);
            REQUIRE(kept.change);
            CHECK(*kept.change > band_change_limit);
        }
}
