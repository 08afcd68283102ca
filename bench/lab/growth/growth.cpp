// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What one iteration takes, in time and memory, at a number of Gaussians and a number of pixels. Prints
/// JSON. The model stays as it is: Gaussians on the surfaces of synthetic:spheres, as large as their
/// distances, half opaque. One question a process, whose peak of memory is the answer's own:
/// bench/lab/growth.py asks many.

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "engine/engine.hpp"
#include "lab.hpp"
#include "readers/load_scene.hpp"
#include "readers/synthetic/synthetic.hpp"
#include "training/initialize.hpp"

namespace gs::lab {

namespace {

constexpr std::size_t view_count = 8;
constexpr std::size_t blocks = 5;  // of steps, each with a time of its own

struct options {
    std::string device = "auto";
    std::size_t gaussians = 100000;
    int side = 512, steps = 40;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app("Time and memory of an iteration");
    app.add_option("--device", o.device)->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("-n,--gaussians", o.gaussians)->check(CLI::Range(1, 100000000))->capture_default_str();
    app.add_option("--side", o.side, "Of the square photos, in pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    app.add_option("--steps", o.steps, "Of each of the 5 blocks that are timed")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    return o;
}

/// Photos of `scene` by its first cameras, at another size.
std::vector<gs::view> photos(const gs::scene& scene, int side) {
    std::vector<gs::view> views(scene.train.begin(), scene.train.begin() + view_count);
    for (gs::view& v : views) {
        gs::camera& c = v.camera;
        const double scale = static_cast<double>(side) / c.width;
        c.width = c.height = side;
        for (double* length : {&c.fx, &c.fy, &c.cx, &c.cy}) *length *= scale;
    }
    gs::photograph_synthetic("spheres", views);
    return views;
}

nlohmann::ordered_json measure(gs::train::engine& engine, const options& o) {
    gs::train::step_plan plan;  // whose rates are zero
    plan.sh_degree = 3;
    const auto steps = [&](int count) {
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < count; ++i) {
            plan.view = static_cast<std::size_t>(i) % view_count;
            ++plan.iteration;
            engine.step(plan);
        }
        engine.profile().wait();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() /
               count;
    };
    steps(static_cast<int>(view_count));
    const std::uint64_t before = engine.profile().pairs();
    engine.profile().sample_times(static_cast<int>(view_count) + 1);
    std::vector<double> milliseconds;
    for (std::size_t b = 0; b < blocks; ++b) milliseconds.push_back(steps(o.steps));
    const auto times = engine.profile().times();
    nlohmann::ordered_json stages;
    for (std::size_t i = 0; i < gs::device::stage_names.size(); ++i)
        stages[gs::device::stage_names[i]] = times.milliseconds[i] / std::max(times.sampled, 1);
    std::ranges::sort(milliseconds);
    return {{"milliseconds", milliseconds[blocks / 2]},
            {"least_milliseconds", milliseconds.front()},
            {"most_milliseconds", milliseconds.back()},
            {"stages", stages},
            {"pairs", static_cast<double>(engine.profile().pairs() - before) /
                          (blocks * static_cast<double>(o.steps))},
            {"skipped_steps", engine.take_report().skipped}};
}

int bench(const options& o) {
    const bool cuda = uses_gpu(o.device);
    const auto engine = cuda ? gs::train::make_cuda_engine() : gs::train::make_cpu_engine();
    gs::load_options small;
    small.data = "synthetic:spheres";
    small.eval = true;
    const gs::scene scene = gs::load_scene(small, {});
    const auto points = gs::synthetic_points("spheres", scene.train, o.gaussians, 0);
    gs::gaussians model = gs::from_points(points, 3, o.gaussians, 0);
    std::ranges::fill(model.opacity, 0.0f);
    engine->set_views(photos(scene, o.side), {});
    engine->set_model(model);
    gs::train::training_setup setup;
    setup.facts.iterations = 0;  // no step collects statistics for densification
    engine->begin(setup);
    engine->reserve();

    nlohmann::ordered_json answer{{"gaussians", engine->count()},
                                  {"pixels", o.side * o.side},
                                  {"steps", o.steps},
                                  {"device", engine->profile().device_name()}};
    answer.update(measure(*engine, o));
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    answer["peak_host_bytes"] = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    answer["peak_device_bytes"] = engine->profile().peak_device_bytes();
    std::cout << answer.dump() << '\n';
    return 0;
}

}  // namespace

int growth(int argc, char** argv) { return bench(parse(argc, argv)); }

}  // namespace gs::lab
