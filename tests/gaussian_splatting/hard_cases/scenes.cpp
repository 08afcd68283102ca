// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>

#include "bounds.hpp"
#include "budget.hpp"
#include "cases.hpp"
#include "lab/accumulator_set.hpp"
#include "readers/load_scene.hpp"
#include "table.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

using namespace hard_cases;

namespace {

/// Over all CPUs, each index on one.
void in_parallel(std::size_t n, const std::function<void(std::size_t)>& f) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(omp_get_num_procs())
    for (std::size_t i = 0; i < n; ++i) f(i);
}

/// Twice what the rounding of a position to a float makes of the alpha of a splat of a pixel's size.
constexpr double margin = 2e-5;

/// What a backend's gradients are measured by, over the pixels off the thresholds.
struct measured {
    render_case q;
    std::size_t moved;  ///< colors that were
    render_result expected;
};

double share_left_out(const std::vector<measured>& all) {
    double out = 0, pixels = 0;
    for (const measured& m : all) {
        out += static_cast<double>(std::count(m.q.weights.begin(), m.q.weights.end(), 0.0));
        pixels += static_cast<double>(m.q.pixels());
    }
    return out / pixels;
}

/// In dark regions the similarity's gradient changes by 2 / C1 = 2e4 times what the image does: there the
/// millionth by which images in float and double differ would be all that is seen. With `one_render` the
/// loss's gradient is taken at the same image by all.
std::vector<measured> measure(const std::vector<render_case>& cases, bool one_render) {
    std::vector<measured> all(cases.size());
    in_parallel(all.size(), [&](std::size_t i) {
        all[i].q = cases[i];
        all[i].moved = move_off_black(all[i].q);
        all[i].q.weights = off_thresholds(all[i].q, margin, 8);
        if (one_render) {
            all[i].q.gradient_at = reference().render(all[i].q).render;
            for (double& x : all[i].q.gradient_at) x = static_cast<float>(x);
        }
        all[i].expected = reference().render(all[i].q);
    });
    return all;
}

/// Each result within the bounds, all gradients of a parameter together without a bias.
void check_all(const std::vector<measured>& all, const backend& b, accumulator how) {
    std::vector<render_result> renders(all.size());
    std::vector<std::string> said(all.size());
    in_parallel(all.size(), [&](std::size_t i) {
        render_case q = all[i].q;
        // A way that knows no skies is not asked for one.
        q.how = q.background_image.empty() || gs::lab::lab_accumulators::supports_background_image(how)
                    ? how
                    : accumulator::native;
        renders[i] = b.render(q);
        said[i] = excess(renders[i], all[i].expected);
        if (distance(renders[i], all[i].expected, q) > 1e-4) said[i] += "the image";
    });
    agreement worst;
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        CHECK(said[i] == "");
        const agreement one = compare(renders[i], all[i].expected);
        worst += {one.error_over_bound, one.cosine, 0};
    }
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        CAPTURE(parameter_names[p]);
        std::vector<double> got, expected;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto &g = renders[i].gradients[p], &e = all[i].expected.gradients[p];
            got.insert(got.end(), g.begin(), g.end());
            expected.insert(expected.end(), e.begin(), e.end());
        }
        const double bias = compare(got, expected).bias;
        CHECK(bias <= 1e-4);
        worst += {0, 1, bias};
    }
    record(worst);
}

std::filesystem::path lego() {
    const char* named = std::getenv("WARPAGG_DATA");
    return (named ? std::filesystem::path(named)
                  : std::filesystem::path(WARPAGG_SOURCE_DIR) / "../shared/data") /
           "lego";
}

/// A model after a short training, a case for each of some of its views.
std::vector<render_case> trained(gs::train::engine& engine, const gs::scene& scene, int iterations) {
    gs::train::train_options o;
    engine.set_views(scene.train, scene.test, o.schedule.num_downscales);
    engine.set_model(gs::from_points(gs::random_points(scene, 5000, 1), 3, 5000, 1));
    o.schedule.iterations = iterations;
    o.schedule.sh_degree_interval = iterations / 4;
    o.densification.of<gs::train::adaptive_config>().densify_from_iter = iterations / 4;
    o.max_cap = gs::train::default_cap(scene);
    gs::train::train_events events;
    events.report = [](const gs::train::progress&) {};
    events.save = events.test = [](int) {};
    gs::train::train(engine, scene, o, events);
    const gs::gaussians model = engine.get_model();
    std::vector<render_case> cases;
    for (std::size_t v = 0; v < scene.train.size(); v += scene.train.size() / (brief ? 1 : 3)) {
        render_case q;
        q.view = scene.train[v];
        const auto put = [&](gs::parameter p, const std::vector<float>& values) {
            q.parameters[static_cast<std::size_t>(p)].assign(values.begin(), values.end());
        };
        put(gs::parameter::mean, model.mean);
        put(gs::parameter::log_scale, model.log_scale);
        put(gs::parameter::quaternion, model.quaternion);
        put(gs::parameter::opacity, model.opacity);
        put(gs::parameter::sh0, model.sh_constant);
        const auto width = static_cast<std::size_t>(model.rest_width());
        for (std::size_t i = 0; i < model.count(); ++i)
            for (std::size_t p = 5, at = i * width; p < gs::parameter_count; ++p)
                for (int k = 0; k < gs::parameter_width[p]; ++k)
                    q.parameters[p].push_back(static_cast<double>(model.sh_rest[at++]));
        cases.push_back(q);
    }
    return cases;
}

}  // namespace

TEST_CASE("100 random scenes: gradients in float against double") {
    std::vector<render_case> cases;
    for (unsigned seed = 100; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const int width = 8 + static_cast<int>(random() % 26), height = 8 + static_cast<int>(random() % 40);
        cases.push_back(random_case(seed, 1 + random() % 49, seed == 100 ? 33 : width,
                                    seed == 100 ? 47 : height, static_cast<int>(seed % 4)));
        cases.back().effects.antialiasing = seed / 4 % 2 == 1;
        if (seed / 8 % 2 == 1) add_background_image(cases.back(), seed);
        take_some_lens(cases.back(), seed);
        if (seed / 32 % 2 == 1) add_depths(cases.back(), seed);
    }
    const std::vector<measured> all = measure(cases, false);
    CHECK(share_left_out(all) < 0.02);
    on_each_variant([&](const backend& b, accumulator how) { check_all(all, b, how); });
}

TEST_CASE("a trained scene: gradients in float against double") {
    gs::load_options o;
    o.data = lego().string();
    o.resolution = 64;
    std::string name = "lego";
    if (!std::filesystem::is_directory(lego())) {
        o.data = "synthetic:spheres";
        name = "synthetic:spheres, since lego is not there";
    }
    const gs::scene scene = gs::load_scene(o, [](const std::string&) {});
    const std::vector<measured> on_cpu =
        measure(trained(*gs::train::make_cpu_engine(), scene, brief ? 40 : 400), true);
#if defined(WARPAGG_TEST_CUDA)
    const std::vector<measured> on_cuda = measure(trained(*gs::train::make_cuda_engine(), scene, 2000), true);
#else
    const std::vector<measured>& on_cuda = on_cpu;
#endif
    // The longer one has many splats a pixel, of which one or the other lies near a threshold.
    CHECK(share_left_out(on_cpu) < 0.1);
    CHECK(share_left_out(on_cuda) < 0.2);
    on_each_variant(
        [&](const backend& b, accumulator how) { check_all(b.name == "cuda" ? on_cuda : on_cpu, b, how); });
    remark(name + ", " + std::to_string(on_cpu[0].q.count()) + " Gaussians on the CPU, " +
           std::to_string(on_cpu.size()) + " views, " + std::to_string(100 * share_left_out(on_cpu)) +
           " % of the pixels left out (" + std::to_string(100 * share_left_out(on_cuda)) + " % on a GPU), " +
           std::to_string(on_cpu[0].moved) + " colors moved off black");
}

TEST_CASE("the variants' gradients agree to 1e-5") {
    render_case q = random_case(7, 300, 64, 48, 3);
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = accumulator::native;
        const render_result ours = b.render(q);
        q.how = how;
        const render_result theirs = b.render(q);
        for (std::size_t p = 0; p < gs::parameter_count; ++p) {
            CAPTURE(parameter_names[p]);
            double apart = 0, mass = 0;
            for (std::size_t i = 0; i < ours.gradients[p].size(); ++i) {
                apart += std::pow(theirs.gradients[p][i] - ours.gradients[p][i], 2);
                mass += std::pow(ours.gradients[p][i], 2);
            }
            CHECK(std::sqrt(apart / mass) < 1e-5);
        }
    });
}
