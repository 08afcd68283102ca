// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// How long the backward blending of a trained model takes with each gradient policy: milliseconds a frame,
/// and times as fast as one atomic per lane. The policies take turns, so that all see the same state of the
/// machine.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "driver.hpp"
#include "error.hpp"
#include "model/ply.hpp"
#include "scene/scene.hpp"
#include "train/engine.hpp"

namespace {

using nlohmann::ordered_json;

struct options {
    std::string ply, output;
    gs::load_options scene;
    std::string device = "auto";
    std::uint64_t model_seed = 0;
    int rounds = 7;
    std::size_t views = 50;
};

options parse(int argc, char** argv) {
    options o;
    o.scene.eval = true;
    CLI::App app("Backward blending by gradient policy");
    app.add_option("ply", o.ply, "A trained model")->required();
    app.add_option("-d,--data", o.scene.data, "Its scene")->required();
    app.add_option("-r,--resolution", o.scene.resolution)->check(CLI::PositiveNumber);
    app.add_option("-o,--output", o.output, "A JSON file");
    app.add_option("--device", o.device)->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("--model-seed", o.model_seed, "The seed that the model was trained with, for the record");
    app.add_option("--rounds", o.rounds, "Turns of each policy")->check(CLI::Range(1, 1000));
    app.add_option("--views", o.views, "Training views in a turn")->check(CLI::Range(1, 100000));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    return o;
}

struct timing {
    std::vector<double> forward, backward;  ///< ms a frame, one a round
};

double median(std::vector<double> x) {
    std::ranges::sort(x);
    return 0.5 * (x[(x.size() - 1) / 2] + x[x.size() / 2]);
}

/// Every view once, nothing learned.
gs::device::stage_times run(gs::train::engine& engine, gs::gradient_policy policy, int sh_degree,
                            std::size_t views, bool white) {
    engine.sample_times(1);
    for (std::size_t v = 0; v < views; ++v) {
        gs::train::step_plan plan;
        plan.view = v;
        plan.sh_degree = sh_degree;
        plan.gradient = policy;
        if (white) plan.background = {1, 1, 1};
        engine.step(plan);
    }
    engine.wait();
    return engine.times();
}

void bench(const options& o) {
    std::string reason;
    const bool cuda = o.device != "cpu" && gs::train::cuda_is_available(reason);
    if (o.device == "cuda" && !cuda) throw gs::error("--device cuda: no GPU can be used: " + reason);
    const auto engine = cuda ? gs::train::make_cuda_engine() : gs::train::make_cpu_engine();
    const gs::scene scene = gs::load_scene(o.scene, [](const std::string& line) { std::puts(line.c_str()); });
    const gs::gaussians model = gs::read_ply(o.ply);
    const std::size_t views = std::min(o.views, scene.train.size());
    engine->set_views(scene.train, {});
    engine->set_model(model);
    engine->reserve();

    constexpr std::size_t policies = gs::gradient_policy_names.size();
    std::array<timing, policies> timings;
    for (int round = -1; round < o.rounds; ++round)  // the first warms up
        for (std::size_t p = 0; p < policies; ++p) {
            const auto t =
                run(*engine, static_cast<gs::gradient_policy>(p), model.sh_degree, views, scene.has_alpha);
            if (round < 0) continue;
            const auto ms = [&](gs::device::stage s) {
                return t.milliseconds[static_cast<std::size_t>(s)] / t.sampled;
            };
            timings[p].forward.push_back(ms(gs::device::stage::blend_forward));
            timings[p].backward.push_back(ms(gs::device::stage::blend_backward));
        }

    ordered_json json{{"bench", "gradient"},
                      {"device", engine->device_name()},
                      {"commit", WARPAGG_COMMIT},
                      {"compiler", WARPAGG_COMPILER},
                      {"nvcc", WARPAGG_NVCC},
                      {"driver", driver_version()},
                      {"model_seed", o.model_seed},
                      {"scene", std::filesystem::path(o.scene.data).filename().string()},
                      {"width", scene.train[0].camera.width},
                      {"height", scene.train[0].camera.height},
                      {"gaussians", model.count()},
                      {"views", views},
                      {"rounds", o.rounds}};
    const double baseline = median(timings[0].backward);
    std::printf("%-12s %14s %22s %8s\n", "policy", "backward ms", "(least to most)", "ratio");
    for (std::size_t p = 0; p < policies; ++p) {
        const auto& t = timings[p];
        const double ms = median(t.backward);
        const auto [least, most] = std::ranges::minmax(t.backward);
        std::printf("%-12s %14.4f %13.4f to %.4f %8.2f\n", gs::gradient_policy_names[p].data(), ms, least,
                    most, baseline / ms);
        json["policies"].push_back({{"name", gs::gradient_policy_names[p]},
                                    {"backward_ms", ms},
                                    {"backward_ms_least", least},
                                    {"backward_ms_most", most},
                                    {"forward_ms", median(t.forward)},
                                    {"times_as_fast", baseline / ms}});
    }
    if (!o.output.empty()) std::ofstream(o.output) << json.dump(2) << '\n';
}

}  // namespace

int main(int argc, char** argv) {
    try {
        bench(parse(argc, argv));
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
