// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Measures the gradient kernel on a trained model, as in the paper's Figures 5, 6 and 9: its time with one
/// atomic per lane, with plain adds instead, and with three reductions; and the number of lanes of a warp
/// that have something to add. bench/lab/paper.py runs it. The kernels take turns, so that all see the same
/// state of the machine, and the gradient of the image is random.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "driver.hpp"
#include "engine/engine.hpp"
#include "lab.hpp"
#include "measure.hpp"
#include "readers/load_scene.hpp"
#include "scene/normalization.hpp"
#include "writers/ply/ply.hpp"

namespace gs::lab {

namespace {

using nlohmann::ordered_json;

struct options {
    std::string ply, output, device = "auto";
    gs::load_options scene;
    std::uint64_t seed = 0;
    int rounds = 7;
    std::size_t views = 50;
};

options parse(int argc, char** argv) {
    options o;
    o.scene.eval = true;
    CLI::App app("The gradient kernel as the paper's figures show it");
    app.add_option("ply", o.ply, "A trained model")->required();
    app.add_option("-d,--data", o.scene.data, "The model's scene")->required();
    app.add_option("--images", o.scene.images, "As in training");
    app.add_option("-r,--resolution", o.scene.resolution, "As in training");
    app.add_option("-o,--output", o.output, "A JSON file")->required();
    app.add_option("--device", o.device)->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("--seed", o.seed);
    app.add_option("--rounds", o.rounds, "Turns of each kernel")->check(CLI::Range(1, 1000));
    app.add_option("--views", o.views, "Training views in a turn")->check(CLI::Range(1, 100000));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    return o;
}

paper_subject subject(const options& o) {
    const gs::scene scene = gs::load_scene(o.scene, [](const std::string& line) { std::puts(line.c_str()); });
    paper_subject s;
    s.model = gs::to_internal(scene.normalization, gs::read_ply(o.ply));
    if (scene.has_alpha) s.background = {1, 1, 1};
    for (std::size_t v = 0; v < std::min(o.views, scene.train.size()); ++v)
        s.cameras.push_back(scene.train[v].camera);
    s.rounds = o.rounds;
    s.seed = o.seed;
    return s;
}

void bench(const options& o) {
    const bool cuda = uses_gpu(o.device);
    const paper_subject s = subject(o);
    const paper_figures f = cuda ? measure_on_cuda(s) : measure_on_cpu(s);

    ordered_json json{{"bench", "paper"},
                      {"device", f.device},
                      {"commit", WARPAGG_COMMIT},
                      {"compiler", WARPAGG_COMPILER},
                      {"nvcc", WARPAGG_NVCC},
                      {"driver", driver_version()},
                      {"seed", o.seed},
                      {"width", s.cameras[0].width},
                      {"height", s.cameras[0].height},
                      {"gaussians", s.model.count()},
                      {"views", s.cameras.size()},
                      {"rounds", o.rounds},
                      {"lanes", f.lanes}};
    const double original = median(f.kernels.front().milliseconds);
    for (const paper_kernel& k : f.kernels) {
        const double ms = median(k.milliseconds);
        const auto [least, most] = std::ranges::minmax(k.milliseconds);
        std::printf("%-12s %9.4f ms (%.4f to %.4f), %.2f times as fast, sums apart %.1e\n", k.name.c_str(),
                    ms, least, most, original / ms, k.apart);
        json["kernels"][k.name] = {{"ms", ms},
                                   {"ms_least", least},
                                   {"ms_most", most},
                                   {"times_as_fast", original / ms},
                                   {"apart", k.apart}};
    }
    json["active_lanes"] = {{"lanes", 32}, {"warps", f.active.warps}, {"listed", f.active.listed}};
    std::ofstream file(o.output);
    file << json.dump(1) << '\n';
    if (!file.flush()) throw gs::error("cannot write " + o.output);
}

}  // namespace

int paper(int argc, char** argv) {
    bench(parse(argc, argv));
    return 0;
}

}  // namespace gs::lab
