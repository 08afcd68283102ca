// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a GPU does in an iteration of training, launch by launch: how long it works, how long it idles, and
/// whether anything is allocated or waited for. Iterations run twice, with CUPTI recording and without: what
/// it records takes time itself.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "driver.hpp"
#include "engine/engine.hpp"
#include "gpu_trace.hpp"
#include "lab.hpp"
#include "readers/load_scene.hpp"
#include "scene/normalization.hpp"
#include "training/schedule.hpp"
#include "writers/ply/ply.hpp"

namespace gs::lab {

namespace {

using clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

struct options {
    std::string ply, output;
    gs::load_options scene;
    int iterations = 90;
};

options parse(int argc, char** argv) {
    options o;
    o.scene.eval = true;
    CLI::App app("What a GPU does in an iteration of training");
    app.add_option("ply", o.ply, "The model that training goes on from")->required();
    app.add_option("-d,--data", o.scene.data, "Its scene")->required();
    app.add_option("-r,--resolution", o.scene.resolution)->check(CLI::PositiveNumber);
    app.add_option("-i,--iterations", o.iterations)->check(CLI::Range(1, 10000));
    app.add_option("-o,--output", o.output, "A JSON file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    return o;
}

/// A trainer between two densifications: it sees every view in turn, and learns from it.
class training {
  public:
    training(const options& o, const gs::scene& scene) : engine_(gs::train::make_cuda_engine()) {
        const gs::gaussians model = gs::to_internal(scene.normalization, gs::read_ply(o.ply));
        plan_.sh_degree = model.sh_degree;
        plan_.rates = gs::train::schedule{}.rates_at(7000);
        if (scene.has_alpha) plan_.background = {1, 1, 1};
        views_ = scene.train.size();
        engine_->set_views(scene.train, {});
        engine_->set_model(model);
        gs::train::training_setup setup;
        setup.facts.iterations = 1 << 20;  // every step collects statistics for densification
        engine_->begin(setup);
        engine_->reserve();
        run(static_cast<int>(2 * views_));         // until nothing grows any more
        engine_->profile().sample_times(1 << 30);  // which takes the next one's times, and no more
        run(1);
    }

    std::size_t gaussians() const { return engine_->count(); }
    std::string device() const { return engine_->profile().device_name(); }

    /// Returns milliseconds an iteration, from the first launch to the last one's end.
    double run(int iterations) {
        const auto start = clock::now();
        for (int i = 0; i < iterations; ++i) {
            plan_.view = (plan_.view + 1) % views_;
            ++plan_.iteration;
            engine_->step(plan_);
        }
        engine_->profile().wait();
        return std::chrono::duration<double, std::milli>(clock::now() - start).count() / iterations;
    }

  private:
    std::unique_ptr<gs::train::engine> engine_;
    gs::train::step_plan plan_;
    std::size_t views_ = 0;
};

/// The totals an iteration, the longest first.
ordered_json table(const char* title, const std::map<std::string, gpu_trace::total>& totals, int iterations) {
    std::vector<std::pair<std::string, gpu_trace::total>> rows(totals.begin(), totals.end());
    std::ranges::sort(rows, std::greater{}, [](const auto& row) { return row.second.nanoseconds; });
    std::printf("\n%-66s %8s %10s\n", title, "times", "us");
    ordered_json json = ordered_json::array();
    for (const auto& [name, t] : rows) {
        const double times = static_cast<double>(t.count) / iterations;
        const double us = static_cast<double>(t.nanoseconds) / 1000 / iterations;
        std::printf("%-66s %8.2f %10.2f\n", name.c_str(), times, us);
        json.push_back({{"name", name}, {"times", times}, {"microseconds", us}});
    }
    return json;
}

void bench(const options& o) {
    std::string reason;
    if (!gs::train::cuda_is_available(reason)) throw gs::error("no GPU can be used: " + reason);
    const gs::scene scene = gs::load_scene(o.scene, [](const std::string& line) { std::puts(line.c_str()); });
    training t(o, scene);
    const double alone = t.run(o.iterations);
    gpu_trace trace;
    const double recorded = t.run(o.iterations);
    gpu_trace::result r = trace.stop();
    // The one wait that ends each run is not an iteration's.
    if (auto& stream = r.waits["stream"]; stream.count > 0) --stream.count;

    const auto each = [&](std::uint64_t ns) { return static_cast<double>(ns) * 1e-6 / o.iterations; };
    std::uint64_t waits = 0;
    for (const auto& [name, total] : r.waits) waits += total.count;
    const double idle = 100 * (1 - each(r.busy) / each(r.wall));
    std::printf("%s, %s, %zu Gaussians, %d x %d, %d iterations\n", t.device().c_str(),
                std::filesystem::path(o.scene.data).filename().c_str(), t.gaussians(),
                scene.train[0].camera.width, scene.train[0].camera.height, o.iterations);
    std::printf(
        "an iteration: %.4f ms of GPU work in %.4f ms, idle %.1f %%; host's clock %.4f ms, %.4f ms while "
        "recorded\n",
        each(r.busy), each(r.wall), idle, alone, recorded);
    std::printf("in all of them: %llu allocations and releases, %llu waits of the host\n",
                static_cast<unsigned long long>(r.allocations), static_cast<unsigned long long>(waits));

    ordered_json json{{"bench", "trace"},
                      {"device", t.device()},
                      {"commit", WARPAGG_COMMIT},
                      {"compiler", WARPAGG_COMPILER},
                      {"nvcc", WARPAGG_NVCC},
                      {"driver", driver_version()},
                      {"scene", std::filesystem::path(o.scene.data).filename().string()},
                      {"width", scene.train[0].camera.width},
                      {"height", scene.train[0].camera.height},
                      {"gaussians", t.gaussians()},
                      {"iterations", o.iterations},
                      {"gpu_work_ms", each(r.busy)},
                      {"gpu_wall_ms", each(r.wall)},
                      {"idle_percent", idle},
                      {"host_wall_ms", alone},
                      {"host_wall_recorded_ms", recorded},
                      {"allocations", r.allocations},
                      {"host_waits", waits}};
    json["work"] = table("work of the GPU, an iteration", r.work, o.iterations);
    json["calls"] = table("calls of the host, an iteration", r.calls, o.iterations);
    json["waits"] = table("waits of the host, an iteration", r.waits, o.iterations);
    if (!o.output.empty()) std::ofstream(o.output) << json.dump(2) << '\n';
}

}  // namespace

int trace(int argc, char** argv) {
    bench(parse(argc, argv));
    return 0;
}

}  // namespace gs::lab
