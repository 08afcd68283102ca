// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <optional>
#include <string>

#include "../core/error.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "report.hpp"

namespace gs::cli {

void evaluate(const settings& s) {
    const command_context context(s);
    const auto engine = context.make_engine();
    const auto network = context.load_lpips();
    const stopwatch loading;
    gaussians model = read_model(s.ply);
    context.require_no_background_before(model);
    scene scene = context.load();
    model = to_internal(scene.normalization, std::move(model));
    if (scene.test.empty()) scene.test = std::move(scene.train);  // without --eval, uses all views
    scene.train.clear();
    const auto background = context.background(scene.has_alpha);
    std::optional<output_folder> output;
    if (!s.output.empty()) output.emplace(s.output);
    engine->set_views(scene.train, scene.test);
    engine->set_model(model);
    const double load_seconds = loading.seconds();

    const stopwatch evaluating;
    const auto report = evaluate::measure_held_out_views(
        *engine, scene, background.color,
        {.folder = output ? output->path() / "test" : std::filesystem::path(),
         .fits_exposure = s.fit_exposure,
         .network = network.get()});
    nlohmann::ordered_json metrics = to_json(report);
    metrics["gaussians"] = model.count();
    metrics["seconds"] = {{"load", load_seconds}, {"evaluate", evaluating.seconds()}};
    metrics["device"] = engine->profile().device_name();
    if (output) write_metrics(output->path(), metrics, report);
    context.say("PSNR " + number("%.2f dB", report.psnr()) + ", SSIM " + number("%.4f", report.ssim()) +
                optional_measures(report) + " over " + std::to_string(report.views.size()) + " views");
}

}  // namespace gs::cli
