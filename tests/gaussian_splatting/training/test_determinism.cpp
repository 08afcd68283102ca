// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>

#include "../hard_cases/budget.hpp"
#include "core/error.hpp"
#include "device/cpu/cpu.hpp"
#include "engines.hpp"
#include "features/depth/depth_feature.hpp"
#include "features/exposure/exposure_feature.hpp"
#include "features/sh_degree/revise_sh_degree.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "render/gradients/gradient_sums.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

/// With growth, a reset of opacities, colors that depend on direction, and Gaussians that lose these.
gs::gaussians trained(gs::train::engine& e, const gs::scene& scene) {
    gs::train::train_options o;
    o.schedule.iterations = 200;
    o.schedule.sh_degree_interval = 40;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 60;
    adaptive.densification_interval = 40;
    adaptive.densify_until_iter = 170;
    adaptive.opacity_reset_interval = 80;
    adaptive.densify_grad_threshold = 1e-5;
    o.max_cap = 4000;
    o.gradient = gs::accumulator::fixed;
    e.set_views(scene.train, {}, o.schedule.num_downscales);
    gs::gaussians model = gs::from_points(scene.points, o.schedule.sh_degree, 500, 1);
    model.antialiased = true;
    model.sky.assign(gs::sky_width, 0.0f);
    o.features = gs::features::feature_set(
        {{"exposure", true, "", gs::features::exposure_feature().neutral_values(scene)},
         {"depth", true, "", gs::features::depth_feature().neutral_values(scene)}});
    e.set_model(model);
    const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::train::training training(e, scene, o, quiet);
    o.features.schedule(training);
    const auto revise = [&](int degree) {
        const auto show = o.features.show_on_host(e, scene);
        return gs::features::revise_sh_degree(e, scene, show, {}, degree).sh_degree;
    };
    gs::features::schedule_revision(training, revise, 0.005);
    training.run();
    return e.get_model();
}

bool are_the_same(const gs::gaussians& a, const gs::gaussians& b) {
    return a.mean == b.mean && a.log_scale == b.log_scale && a.quaternion == b.quaternion &&
           a.opacity == b.opacity && a.sh_constant == b.sh_constant && a.sh_rest == b.sh_rest &&
           a.sky == b.sky;
}

}  // namespace

TEST_CASE("sums in fixed point make training repeatable, with any number of threads") {
    const gs::scene scene = small_scene("synthetic:spheres,depths=0.02");
    const int threads = omp_get_max_threads();
    for (const auto make : engines()) {
        const gs::gaussians first = trained(*make(), scene);
        CHECK(first.count() > 700);
        REQUIRE(first.sh_degree > 0);
        const auto last = first.sh_rest.end() - first.rest_width();
        CHECK(std::all_of(last, first.sh_rest.end(), [](float x) { return x == 0; }));
        CHECK(std::ranges::any_of(first.sh_rest, [](float x) { return x != 0; }));
        for (const int n : {1, 2, 9}) {  // 9: the images fall into other strips
            if (n > 1 && hard_cases::brief) continue;
            CAPTURE(n);
            omp_set_num_threads(n);
            CHECK(are_the_same(trained(*make(), scene), first));
        }
        omp_set_num_threads(threads);
    }
}

TEST_CASE("fixed point refuses images of so many patches that a sum could overflow") {
    using device = gs::device::cpu;
    device d;
    gs::raster::gradient_sums<device, float> sums(d);
    constexpr std::size_t most = std::size_t{1} << gs::raster::fixed_log_warps;
    using set = gs::raster::product_accumulators;
    for (const auto how : {gs::accumulator::native, gs::accumulator::fixed})
        set::with_kernel<float, gs::raster::cut_for<device::warp>>(how, [&](auto kernel) {
            sums.begin(kernel, 1, 1, most);
            if (how == gs::accumulator::fixed)
                CHECK_THROWS_WITH_AS(sums.begin(kernel, 1, 1, most + 1), doctest::Contains("2^18 patches"),
                                     gs::error);
            else
                CHECK_NOTHROW(sums.begin(kernel, 1, 1, most + 1));
        });
}
