// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Long training under hostile schedules and on hostile scenes: whether all stays finite, and how good it
/// gets. The exit status is 1 if something did not stay finite, or a .ply is not in its scene's coordinates.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "driver.hpp"
#include "stress_scenes.hpp"
#include "training/initialize.hpp"
#include "writers/ply/ply.hpp"

namespace {

using nlohmann::ordered_json;

struct options {
    std::string device = "auto", output;
    int iterations = 30000, large_iterations = 1000, resolution = 96;
    std::size_t large_count = 5000000;
    std::uint64_t seed = 0;
    std::vector<std::string> only;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app("Long training under hostile schedules");
    std::set<std::string> names;
    for (const hard_case& c : hard_cases()) names.insert(c.name);
    app.add_option("--device", o.device)->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("-i,--iterations", o.iterations)->check(CLI::Range(1, 10000000));
    app.add_option("-r,--resolution", o.resolution, "Pixels, a side of the photos")
        ->check(CLI::Range(16, 2048));
    app.add_option("--large-iterations", o.large_iterations, "Of many_gaussians")
        ->check(CLI::Range(1, 10000000));
    app.add_option("--large-count", o.large_count, "Gaussians of many_gaussians")
        ->check(CLI::Range(1, 100000000));
    app.add_option("--only", o.only, "A case, by its name; may be repeated")->check(CLI::IsMember(names));
    app.add_option("--seed", o.seed);
    app.add_option("-o,--output", o.output, "A JSON file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        std::exit(app.exit(e));
    }
    return o;
}

bool all_finite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float x) { return std::isfinite(x); });
}

bool all_finite(const gs::gaussians& m) {
    return all_finite(m.mean) && all_finite(m.log_scale) && all_finite(m.quaternion) &&
           all_finite(m.opacity) && all_finite(m.sh_constant) && all_finite(m.sh_rest);
}

bool renders_are_finite(gs::train::engine& engine, const std::vector<gs::view>& views) {
    return std::ranges::all_of(views,
                               [&](const gs::view& v) { return all_finite(engine.render(v.camera, {})); });
}

/// The mean over the views that `engine` measures by these numbers; nothing without any.
ordered_json mean_psnr(gs::train::engine& engine, std::size_t first, std::size_t last) {
    if (first == last) return nullptr;
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += engine.measure(i, {}).psnr();
    return sum / static_cast<double>(last - first);
}

/// Whether half of the Gaussians are where the spheres are, by each coordinate. No frame is asked.
bool is_in_place(const gs::gaussians& model, const trial& t) {
    const std::size_t n = model.count();
    for (std::size_t axis = 0; axis < 3 && n > 0; ++axis) {
        std::vector<float> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = model.mean[3 * i + axis];
        std::ranges::nth_element(x, x.begin() + static_cast<std::ptrdiff_t>(n / 2));
        const double world =
            static_cast<double>(x[n / 2]) / t.scale - t.offset[static_cast<glm::length_t>(axis)];
        if (!(std::abs(world) < 2)) return false;
    }
    return true;
}

class temporary_file {
  public:
    temporary_file() : path_("/tmp/bench_stability_" + std::to_string(getpid()) + ".ply") {}
    ~temporary_file() { std::remove(path_.c_str()); }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

/// Trains, and adds to `row` what came of it.
void run(trial& t, gs::train::engine& engine, ordered_json& row) {
    gs::scene& scene = t.scene;
    gs::normalize(scene, [](const std::string& line) { std::puts(line.c_str()); });
    std::vector<gs::view> views = scene.train;
    views.insert(views.end(), scene.test.begin(), scene.test.end());
    engine.set_views(scene.train, views, t.schedule.num_downscales);
    engine.set_model(gs::from_points(scene.points, t.schedule.sh_degree, t.cap, t.seed));
    row["first_gaussians"] = engine.count();

    gs::train::train_options o;
    o.schedule = t.schedule;
    o.densification.of<gs::train::adaptive_config>() = t.adaptive;
    o.max_cap = t.cap;
    o.seed = t.seed;
    const gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    const auto result = gs::train::train(engine, scene, o, events);
    const gs::gaussians model = engine.get_model();
    const std::size_t trained = scene.train.size(), all = views.size();
    row["gaussians"] = model.count();
    row["skipped_steps"] = result.skipped_steps;
    row["left_out_gradients"] = result.left_out_gradients;
    row["silent_gaussians"] = result.without_gradient;
    row["seconds"] = result.seconds;
    row["training_psnr"] = mean_psnr(engine, 0, trained);
    row["held_out_psnr"] = mean_psnr(engine, trained, all);
    row["finite_parameters"] = all_finite(model);
    row["finite_renders"] = renders_are_finite(engine, views);

    const temporary_file file;
    gs::write_ply(file.path(), gs::to_world(scene.normalization, model));
    const gs::gaussians saved = gs::read_ply(file.path());  // refuses values that are not finite
    row["ply_in_place"] = is_in_place(saved, t);
    engine.set_model(gs::to_internal(scene.normalization, saved));
    row["ply_training_psnr"] = mean_psnr(engine, 0, trained);
}

bool is_sound(const ordered_json& row) {
    return !row.contains("error") && row["finite_parameters"] && row["finite_renders"] &&
           row["ply_in_place"] && !std::isnan(row["training_psnr"].get<double>()) &&
           !std::isnan(row["ply_training_psnr"].get<double>());
}

int bench(const options& o) {
    std::string reason;
    const bool cuda = o.device != "cpu" && gs::train::cuda_is_available(reason);
    if (o.device == "cuda" && !cuda) throw gs::error("--device cuda: no GPU can be used: " + reason);
    const auto make = cuda ? gs::train::make_cuda_engine : gs::train::make_cpu_engine;
    gs::load_options spheres;
    spheres.data = "synthetic:spheres";
    spheres.eval = true;
    spheres.resolution = o.resolution;
    spheres.seed = o.seed;

    ordered_json json{{"bench", "stability"},
                      {"device", make()->profile().device_name()},
                      {"driver", driver_version()},
                      {"nvcc", WARPAGG_NVCC},
                      {"compiler", WARPAGG_COMPILER},
                      {"commit", WARPAGG_COMMIT},
                      {"seed", o.seed},
                      {"resolution", o.resolution},
                      {"iterations", o.iterations}};
    std::printf("%-18s %10s %10s %10s %10s %10s %8s %8s\n", "case", "Gaussians", "training", "held out",
                ".ply", "skipped", "seconds", "sound");
    bool all_sound = true;
    for (const hard_case& c : hard_cases()) {
        if (!o.only.empty() && std::ranges::find(o.only, c.name) == o.only.end()) continue;
        trial t;
        t.scene = gs::load_scene(spheres, {});
        t.schedule.iterations = o.iterations;
        t.cap = gs::train::default_cap(t.scene);
        t.seed = o.seed;
        t.large_count = o.large_count;
        t.large_iterations = o.large_iterations;
        c.make(t);
        ordered_json row{{"name", c.name}, {"what", c.what}, {"iterations", t.schedule.iterations.last()}};
        try {
            run(t, *make(), row);
        } catch (const std::exception& problem) {
            row["error"] = problem.what();
        }
        row["sound"] = is_sound(row);
        all_sound = all_sound && row["sound"];
        const auto number = [&](const char* key) {
            return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
        };
        std::printf("%-18s %10.0f %10.2f %10.2f %10.2f %10.0f %8.1f %8s%s\n", c.name, number("gaussians"),
                    number("training_psnr"), number("held_out_psnr"), number("ply_training_psnr"),
                    number("skipped_steps"), number("seconds"), row["sound"] ? "yes" : "NO",
                    row.contains("error") ? (" " + row["error"].get<std::string>()).c_str() : "");
        std::fflush(stdout);
        json["rows"].push_back(std::move(row));
    }
    if (!o.output.empty() && !(std::ofstream(o.output) << json.dump(2) << '\n').flush())
        throw gs::error("cannot write " + o.output);
    return all_sound ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return bench(parse(argc, argv));
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
