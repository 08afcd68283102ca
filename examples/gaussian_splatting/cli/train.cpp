// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "../core/error.hpp"
#include "../densify/adaptive/adaptive_schedule.hpp"
#include "../features/exposure/held_out_exposures.hpp"
#include "../features/sh_degree/revise_sh_degree.hpp"
#include "../training/initialise.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "progress_bar.hpp"

namespace gs::cli {

namespace {

using nlohmann::ordered_json;

train::train_options options_of(const settings& s, const scene& scene,
                                const train::background_choice& background,
                                const effects::simulation& simulated) {
    train::train_options o;
    o.schedule = s.schedule;
    o.schedule.sh_degree = simulated.sh_degree;
    for (const float gain : simulated.exposures)
        o.exposures.push_back({gain, 0, 0, 0, 0, gain, 0, 0, 0, 0, gain, 0});
    o.depth_fits = simulated.depth_fits;
    o.densification = s.densification;
    o.max_cap =
        s.max_cap > 0 ? s.max_cap : std::max(train::default_cap(scene), s.densification.adaptive.budget);
    o.seed = s.seed;
    o.gradient = s.deterministic ? accumulator::fixed : accumulator::native;
    o.background = background;
    o.save_iterations = s.save_iterations;
    o.save_iterations.insert(s.schedule.iterations);
    o.test_iterations = s.test_iterations;
    return o;
}

/// The scene's points, or random ones: half as many as there may be, so that there is room to grow where it
/// matters.
gaussians first_model(const scene& scene, const train::train_options& o) {
    constexpr std::size_t most_random = 100000;
    const std::size_t budget = o.densification.adaptive.budget, most = budget > 0 ? budget : o.max_cap;
    const auto points = scene.points.empty()
                            ? random_points(scene, std::min(most_random, most / 2 + 1), o.seed)
                            : scene.points;
    return from_points(points, o.schedule.sh_degree, most, o.seed);
}

std::filesystem::path ply_of(const std::filesystem::path& output, int iteration) {
    return output / "point_cloud" / ("iteration_" + std::to_string(iteration)) / "point_cloud.ply";
}

std::filesystem::path pictures_of(const std::filesystem::path& output, int iteration) {
    return output / "test" / ("ours_" + std::to_string(iteration));
}

/// The names of what is simulated.
ordered_json effects_on(const effects::simulation& simulated) {
    ordered_json names = ordered_json::array();
    for (const auto& o : simulated.outcomes)
        if (o.on) names.push_back(o.name);
    return names;
}

ordered_json settings_json(const settings& s, const train::train_options& o,
                           const effects::simulation& simulated) {
    const train::schedule& plan = o.schedule;
    const train::adaptive_config& adaptive = o.densification.adaptive;
    const train::adaptive_schedule densification(adaptive, {.iterations = plan.iterations});
    return {{"data", s.scene.data},
            {"images", s.scene.images},
            {"resolution", s.scene.resolution},
            {"eval", s.scene.eval},
            {"test_every", s.scene.test_every},
            {"quality", s.quality},
            {"iterations", plan.iterations},
            {"effects", effects_on(simulated)},
            {"reviews_bands", simulated.reviews_bands},
            {"fit_exposure", s.fit_exposure},
            {"sh_degree", plan.sh_degree},
            {"sh_degree_interval", plan.sh_degree_interval},
            {"position_lr_init", plan.position_lr_init},
            {"position_lr_final", plan.position_lr_final},
            {"feature_lr", plan.feature_lr},
            {"sh_lr", plan.sh_rate()},
            {"opacity_lr", plan.opacity_lr},
            {"scaling_lr", plan.scaling_lr},
            {"rotation_lr", plan.rotation_lr},
            {"opacity_reset_interval", adaptive.opacity_reset_interval},
            {"densification_interval", adaptive.densification_interval},
            {"densify_from_iter", adaptive.densify_from_iter},
            {"densify_until_iter", densification.densify_until()},
            {"num_downscales", plan.num_downscales},
            {"resolution_schedule", plan.resolution_interval()},
            {"sh_update_interval", plan.sh_update_interval},
            {"prune_share", densification.share_to_prune()},
            {"densify_grad_threshold", densification.growth_threshold()},
            {"max_cap", o.max_cap},
            {"budget", adaptive.budget},
            {"revised_opacity", adaptive.revised_opacity},
            {"deterministic", s.deterministic},
            {"save_iterations", o.save_iterations},
            {"test_iterations", o.test_iterations},
            {"background", s.background},
            {"device", s.device},
            {"seed", s.seed}};
}

/// What was simulated of a scene, why, and what training made of it.
ordered_json effects_json(const settings& s, const scene& scene, const train::background_choice& background,
                          const effects::simulation& simulated,
                          const std::optional<effects::band_review>& review,
                          const train::train_result& result) {
    ordered_json all = ordered_json::array();
    for (const auto& o : simulated.outcomes)
        all.push_back({{"name", o.name}, {"on", o.on}, {"reason", o.reason}});
    ordered_json& direction = all[static_cast<std::size_t>(effects::effect::direction)];
    direction["sh_degree"] = result.sh_degree;
    if (review) {
        direction["on"] = result.sh_degree > 0;
        if (result.banded) direction["gaussians_with_bands"] = *result.banded;
        direction["sh_degree_at_first"] = simulated.sh_degree;
        direction["unexplained_half_way"] = review->unexplained;
        if (review->change) direction["change_without_highest_band"] = *review->change;
    }
    all.push_back({{"name", "background"},
                   {"on", scene.has_alpha || background.random},
                   {"reason", !scene.has_alpha ? "--background " + s.background
                              : simulated.exposures.empty()
                                  ? "the photos have transparent parts"
                                  : "the photos have transparent parts; black, since they have exposures"}});
    return all;
}

/// By photo, three rows of four numbers: as the implementation of Kerbl et al. 2024 writes them.
ordered_json exposures_json(const std::vector<view>& views, const std::vector<train::exposure>& exposures) {
    ordered_json all = ordered_json::object();
    for (std::size_t v = 0; v < exposures.size(); ++v) {
        const train::exposure& e = exposures[v];
        for (std::size_t row = 0; row < 3; ++row)
            all[views[v].name].push_back({e[4 * row], e[4 * row + 1], e[4 * row + 2], e[4 * row + 3]});
    }
    return all;
}

/// Milliseconds of an iteration by stage, and nanoseconds a pixel-Gaussian pair where pairs are what a stage
/// works on.
ordered_json stages_json(const device::stage_times& times, double pairs_per_iteration) {
    ordered_json stages;
    for (std::size_t i = 0; i < device::stage_names.size(); ++i) {
        const double ms = times.milliseconds[i] / std::max(times.sampled, 1);
        stages[device::stage_names[i]] = {{"milliseconds", ms},
                                          {"nanoseconds_per_pair", ms * 1e6 / pairs_per_iteration}};
    }
    return stages;
}

std::size_t peak_host_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string number(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace

void train(const settings& s) {
    const session session(s);
    const auto engine = session.make_engine();
    const stopwatch loading;
    scene scene = session.load();
    effects::simulation simulated = effects::simulate(scene, s.effects, s.sh_degree);
    if (!simulated.sky.empty() && s.background != "auto")
        simulated.leave_out(effects::effect::sky, "--background " + s.background);
    for (const auto& o : simulated.outcomes) session.say(o.name + (o.on ? " on: " : " off: ") + o.reason);
    if (!simulated.exposures.empty() && (s.background == "white" || s.background == "random"))
        throw error(
            "--background " + s.background +
            ": exposures would change it with the photos; it has to be black, or --effects -exposure");
    const train::background_choice background =
        session.background(scene.has_alpha && simulated.exposures.empty());
    train::train_options options = options_of(s, scene, background, simulated);
    std::optional<effects::band_review> review;
    if (simulated.reviews_bands) {
        options.review_bands = [&](int sh_degree) {
            review = effects::review_bands(*engine, scene, background.colour, sh_degree);
            return review->sh_degree;
        };
        options.band_change = effects::single_band_change_limit;
    }
    gaussians model = first_model(scene, options);
    model.antialiased = simulated.antialiasing;
    model.sky = simulated.sky;
    const output_folder output(s.output);
    for (std::size_t v = 0; v < scene.train.size(); ++v)
        if (options.depth_fits.empty() || options.depth_fits[v].scale == 0) scene.train[v].depths = {};
    for (view& v : scene.test) v.depths = {};
    engine->set_views(scene.train, scene.test, options.schedule.num_downscales);
    engine->set_model(model);
    const double load_seconds = loading.seconds();
    session.say("training on " + engine->device_name() + ": " + std::to_string(scene.train.size()) +
                " views, " + std::to_string(model.count()) + " Gaussians, at most " +
                std::to_string(options.max_cap));

    ordered_json tested = ordered_json::array();
    progress_bar bar(s.quiet);
    train::progress last;
    train::train_events events;
    events.report = [&](const train::progress& p) {
        last = p;
        bar.show(p);
    };
    events.save = [&](int iteration) {
        const auto file = ply_of(output.path(), iteration);
        std::filesystem::create_directories(file.parent_path());
        write_model(file, out_of(scene.frame, engine->get_model()));
    };
    const auto expose_tests = [&](const std::vector<train::exposure>& of_training) {
        if (!of_training.empty()) engine->set_test_exposures(evaluate::test_exposures(scene, of_training));
    };
    events.test = [&](int iteration) {
        if (!options.exposures.empty()) expose_tests(engine->exposures());
        const auto report = evaluate::measure_test_views(*engine, scene, background.colour, {});
        tested.push_back({{"iteration", iteration},
                          {"seconds", last.seconds},
                          {"psnr", report.psnr()},
                          {"ssim", report.ssim()}});
        bar.clear();
        session.say("iteration " + std::to_string(iteration) + ": held-out PSNR " +
                    number("%.2f dB", report.psnr()));
    };
    events.warn = [&](const std::string& line) {
        bar.clear();
        session.say("warning: " + line);
    };
    const train::train_result result = train::train(*engine, scene, options, events);
    const device::stage_times times = engine->times();
    const double pairs = static_cast<double>(engine->pairs()) / options.schedule.iterations;

    const stopwatch evaluating;
    // What is measured is what the file holds, which float has rounded in the scene's own frame.
    engine->set_model(into(scene.frame, out_of(scene.frame, engine->get_model())));
    expose_tests(result.exposures);
    const auto pictures = pictures_of(output.path(), options.schedule.iterations);
    const auto report = evaluate::measure_test_views(*engine, scene, background.colour, pictures,
                                                     s.fit_exposure || !simulated.exposures.empty());

    ordered_json metrics = to_json(report);
    metrics["training_psnr"] = last.psnr;
    metrics["tests"] = tested;
    metrics["iterations"] = options.schedule.iterations;
    metrics["gaussians"] = engine->count();
    metrics["seconds"] = {
        {"load", load_seconds}, {"train", result.seconds}, {"evaluate", evaluating.seconds()}};
    metrics["iterations_per_second"] = options.schedule.iterations / result.seconds;
    metrics["densify_seconds"] = result.densify_seconds;
    metrics["skipped_steps"] = result.skipped_steps;
    metrics["left_out_gradients"] = result.left_out_gradients;
    metrics["left_out_sums"] = result.left_out_sums;
    metrics["silent_gaussians"] = result.without_gradient;
    metrics["pairs_per_iteration"] = pairs;
    metrics["stages"] = stages_json(times, pairs);
    metrics["peak_host_bytes"] = peak_host_bytes();
    metrics["peak_device_bytes"] = engine->peak_device_bytes();
    metrics["device"] = engine->device_name();
    metrics["deterministic"] = s.deterministic;
    metrics["effects"] = effects_json(s, scene, background, simulated, review, result);
    metrics["seed"] = s.seed;
    write_json(output.path() / "settings.json", settings_json(s, options, simulated));
    if (!result.exposures.empty()) {
        const auto of_tests = evaluate::test_exposures(scene, result.exposures);
        write_json(output.path() / "exposures.json",
                   {{"train", exposures_json(scene.train, result.exposures)},
                    {"test", exposures_json(scene.test, of_tests)}});
    } else {
        std::filesystem::remove(output.path() / "exposures.json");  // of a training before
    }
    write_json(output.path() / "metrics.json", metrics);

    if (result.banded)
        session.say(std::to_string(engine->count() - *result.banded) + " of " +
                    std::to_string(engine->count()) + " Gaussians have one colour from all directions");
    if (report.views.empty()) {
        session.say("training PSNR " + number("%.2f dB", last.psnr) + " (no held-out views without --eval)");
    } else {
        session.say("held-out PSNR " + number("%.2f dB", report.psnr()) + ", SSIM " +
                    number("%.4f", report.ssim()) + fitted_part(report) + " over " +
                    std::to_string(report.views.size()) + " views");
        session.say(
            "picture   " + (pictures / "renders" / evaluate::picture_names(scene.test).front()).string() +
            (report.views.size() > 1 ? " and " + std::to_string(report.views.size() - 1) + " more" : ""));
    }
    session.say("model     " + ply_of(output.path(), options.schedule.iterations).string());
    session.say("metrics   " + (output.path() / "metrics.json").string());
}

}  // namespace gs::cli
