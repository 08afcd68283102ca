// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Times the blending with each variant, backward and forward: milliseconds per view, and the ratio to one
/// atomic per lane. The ladder leads from the original kernel to the trainer's in steps; the contenders are
/// alternatives to the trainer's kernel. The variants take turns, so that all see the same state of the
/// machine, and the gradient of the image is random. A pair is a pixel and a Gaussian whose exponent is
/// computed there: a pixel of a patch that the Gaussian reaches. The time of a pair is that of one core.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "core/error.hpp"
#include "driver.hpp"
#include "engine/engine.hpp"
#include "lab.hpp"
#include "ranking.hpp"
#include "readers/load_scene.hpp"
#include "scene/look_at.hpp"
#include "scene/normalization.hpp"
#include "writers/ply/ply.hpp"

namespace gs::lab {

namespace {

using nlohmann::ordered_json;

struct options {
    std::string ply, output, device = "auto";
    gs::load_options scene;
    double scale = 1;
    std::uint64_t seed = 0;
    int rounds = 7;
    std::size_t views = 50;
    bool compares_accumulations = false;
};

options parse(int argc, char** argv) {
    options o;
    o.scene.eval = true;
    CLI::App app("Blending, backward and forward, by variant");
    app.add_option("ply", o.ply, "A trained model; without one: a million random Gaussians");
    app.add_option("-d,--data", o.scene.data, "The model's scene")->needs(app.get_option("ply"));
    app.add_option("--scale", o.scale, "Pictures are this many times as wide and high as the photos")
        ->check(CLI::Range(0.01, 100.0));
    app.add_option("-o,--output", o.output, "A JSON file");
    app.add_option("--device", o.device)->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("--seed", o.seed);
    app.add_option("--rounds", o.rounds, "Turns of each variant")->check(CLI::Range(1, 1000));
    app.add_option("--views", o.views, "Training views in a turn")->check(CLI::Range(1, 100000));
    app.add_flag("--accumulate", o.compares_accumulations,
                 "The ways of keeping the default's sums instead, and their distance from sums in double");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    if (o.ply.empty() != o.scene.data.empty()) throw gs::error("a model needs its scene: --data");
    return o;
}

/// A crowd that fills a cube, seen from a ring around it.
ranking_setup random_crowd(std::uint64_t seed) {
    constexpr std::size_t count = 1000000;
    std::mt19937_64 random(seed);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform(-1.3f, 1.3f);
    ranking_setup c;
    gs::gaussians& m = c.model;
    m.sh_degree = 3;
    const auto fill = [&](std::vector<float>& v, std::size_t n, auto draw) {
        v.resize(n);
        std::ranges::generate(v, draw);
    };
    fill(m.mean, 3 * count, [&] { return uniform(random); });
    fill(m.log_scale, 3 * count, [&] { return std::log(0.008f) + 0.6f * normal(random); });
    fill(m.quaternion, 4 * count, [&] { return normal(random); });
    fill(m.opacity, count, [&] { return 1.5f * normal(random); });
    fill(m.sh_constant, 3 * count, [&] { return 0.6f * normal(random); });
    fill(m.sh_rest, 45 * count, [&] { return 0.05f * normal(random); });
    for (int k = 0; k < 8; ++k) {
        const double turn = k * 2 * 3.14159265358979 / 8;
        gs::camera view =
            gs::look_at({2.8 * std::cos(turn), 2.8 * std::sin(turn), 0.5}, {0, 0, 0}, {0, 0, 1}, 1600, 1200);
        view.height = 1066;
        view.cy = 533;
        c.cameras.push_back(view);
    }
    return c;
}

ranking_setup trained(const options& o) {
    const gs::scene scene = gs::load_scene(o.scene, [](const std::string& line) { std::puts(line.c_str()); });
    ranking_setup c;
    c.model = gs::to_internal(scene.normalization, gs::read_ply(o.ply));
    if (scene.has_alpha) c.background = {1, 1, 1};
    for (std::size_t v = 0; v < std::min(o.views, scene.train.size()); ++v) {
        gs::camera view = scene.train[v].camera;
        view.width = static_cast<int>(std::lround(view.width * o.scale));
        view.height = static_cast<int>(std::lround(view.height * o.scale));
        view.fx *= o.scale;
        view.fy *= o.scale;
        view.cx *= o.scale;
        view.cy *= o.scale;
        c.cameras.push_back(view);
    }
    return c;
}

void bench(const options& o) {
    const bool cuda = uses_gpu(o.device);
    ranking_setup c = o.ply.empty() ? random_crowd(o.seed) : trained(o);
    c.rounds = o.rounds;
    c.seed = o.seed;
    c.compares_accumulations = o.compares_accumulations;
    if (c.compares_accumulations) c.reference_fp64 = sums_in_fp64(c);
    const ranking result = cuda ? rank_on_cuda(c) : rank_on_cpu(c);

    const std::string scene =
        o.ply.empty() ? "random" : std::filesystem::path(o.scene.data).filename().string();
    ordered_json json{{"bench", "backward"},
                      {"device", result.device},
                      {"commit", WARPAGG_COMMIT},
                      {"compiler", WARPAGG_COMPILER},
                      {"nvcc", WARPAGG_NVCC},
                      {"driver", driver_version()},
                      {"seed", o.seed},
                      {"scene", scene},
                      {"width", c.cameras[0].width},
                      {"height", c.cameras[0].height},
                      {"gaussians", c.model.count()},
                      {"views", c.cameras.size()},
                      {"rounds", o.rounds},
                      {"cores", result.cores}};
    std::printf("%s, %d x %d, %zu Gaussians, %zu views\n%-47s %9s %20s %6s %9s %9s %21s %8s %8s\n",
                scene.c_str(), c.cameras[0].width, c.cameras[0].height, c.model.count(), c.cameras.size(),
                "variant", "backward", "(least to most), ms", "ratio", "forward", "M pairs",
                "ns a pair (forward)", "apart", "error");
    const double baseline = median(result.standings.front().backward);
    for (const standing& s : result.standings) {
        const double ms = median(s.backward), forward = median(s.forward);
        const auto [least, most] = std::ranges::minmax(s.backward);
        // The time of one core, assuming that all cores were busy throughout.
        const auto a_pair = [&](double milliseconds) { return milliseconds * 1e6 * result.cores / s.pairs; };
        std::printf("%-47s %9.4f   %.4f to %.4f %6.2f %9.4f %9.2f %12.3f (%.3f) %8.1e %8.1e\n",
                    s.name.c_str(), ms, least, most, baseline / ms, forward, s.pairs / 1e6, a_pair(ms),
                    a_pair(forward), s.apart, s.error);
        json[o.compares_accumulations ? "accumulations"
             : s.rung                 ? "ladder"
                                      : "contenders"]
            .push_back({{"name", s.name},
                        {"backward_ms", ms},
                        {"backward_ms_least", least},
                        {"backward_ms_most", most},
                        {"forward_ms", forward},
                        {"pairs", s.pairs},
                        {"backward_ns_a_pair_and_core", a_pair(ms)},
                        {"forward_ns_a_pair_and_core", a_pair(forward)},
                        {"apart", s.apart},
                        {"error", s.error},
                        {"times_as_fast", baseline / ms}});
    }
    if (!o.output.empty()) std::ofstream(o.output) << json.dump(2) << '\n';
}

}  // namespace

int backward(int argc, char** argv) {
    bench(parse(argc, argv));
    return 0;
}

}  // namespace gs::lab
