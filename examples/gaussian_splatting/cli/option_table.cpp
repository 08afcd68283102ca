// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "option_table.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "../losses/loss_names.hpp"
#include "../poses/video_frames.hpp"
#include "../ranks/communicator.hpp"
#include "../writers/writer.hpp"
#include "convert_options.hpp"
#include "length_options.hpp"
#include "memory_options.hpp"
#include "page_options.hpp"
#include "view_options.hpp"

// The table of all options, group by group. An option is one row here and one member of `settings`.
// The table is the source of the command line with its checks and help, of settings.json, and of
// docs/reference/cli.md.

namespace gs::cli {

namespace {

using rows = std::vector<option>;
using namespace options;
using enum command;

/// Returns the names of the effects that users can select.
std::vector<std::string> effect_names() {
    std::vector<std::string> names;
    for (const auto& f : features::all_features())
        if (f->is_selectable()) names.emplace_back(f->name());
    return names;
}

option_value effect_list(features::selection& member) {
    std::vector<std::string> suggestions = effect_names();
    suggestions.insert(suggestions.begin(), {"auto", "all", "none"});
    return {.type = "LIST",
            .range = "",
            .read = [&member](const std::string& word) { member = features::parse_selection(word); },
            .json = [&member] { return nlohmann::ordered_json(member.text); },
            .suggestions = suggestions};
}

rows grouped(const std::string& heading, rows all) {
    for (option& row : all) row.group = heading;
    return all;
}

rows model_options(settings& s) {
    return grouped(
        "Model", {{.names = "ply",
                   .commands = {evaluate, render, view},
                   .value = text(s.ply, "FILE"),
                   .help = "Model to read: a file with the ending " + readable_endings(all_writers(), " or "),
                   .required = {evaluate, render, view}},
                  {.names = "input",
                   .commands = {convert},
                   .value = text(s.ply, "IN"),
                   .help = "Model to read: a file with the ending " + readable_endings(all_writers(), " or "),
                   .required = {convert}},
                  {.names = "output",
                   .commands = {convert},
                   .value = text(s.output, "OUT"),
                   .help = "Model to write or to replace: a file with the ending " +
                           writable_endings(all_writers(), " or "),
                   .required = {convert}}});
}

rows scene_options(settings& s) {
    return grouped(
        "Scene",
        {{.names = "-d,--data,-s,--source-path",
          .commands = {train, evaluate, render, inspect},
          .value = text(s.scene.data, "SCENE"),
          .help = "Scene to read: " + accepted_scenes() + "; train also takes photos, see --poses",
          .default_text = "none; render then draws an orbit around the model",
          .required = {train, evaluate, inspect}},
         {.names = "-d,--data,-s,--source-path",
          .commands = {convert},
          .value = text(s.scene.data, "SCENE"),
          .help = "Scene whose cameras --remove-floaters uses: " + accepted_scenes(),
          .default_text = "none",
          .needs = {"--remove-floaters"}},
         {.names = "--images",
          .commands = {train, evaluate, render, convert, inspect},
          .value = text(s.scene.images, "FOLDER"),
          .help = "Folder of the photos inside the scene's folder (for " + readers_with("--images") + ")",
          .needs = {"--data"}},
         {.names = "-r,--resolution",
          .commands = {train, evaluate, render, inspect},
          .value = whole(s.scene.resolution, 1, 65536),
          .help = "Image size: 1, 2, 4 and 8 divide the size of the photos; any other number is the length "
                  "of the longer side in pixels"},
         {.names = "--eval",
          .commands = {train, evaluate, render, inspect},
          .value = flag(s.scene.eval),
          .help = "Holds out test views, on which the model is measured",
          .needs = {"--data"}},
         {.names = "--test-every",
          .commands = {train, evaluate, render, inspect},
          .value = whole(s.scene.test_every, 2, 1000000),
          .help = "Distance between two held-out views in the list of photos sorted by name (for " +
                  readers_with("--test-every") + ")",
          .unit = "views",
          .needs = {"--eval"}},
         {.names = "!--no-masks",
          .commands = {evaluate},
          .value = flag(s.scene.masks),
          .help = "Measures the masked pixels of the photos, too"},
         {.names = "--background",
          .commands = {train, evaluate, render, view},
          .value = choice(s.background),
          .help = "Background color behind the Gaussians: auto is white if photos have transparent parts "
                  "and black otherwise; random, for train only, changes with every iteration"},
         {.names = "-w,--white-background",
          .commands = {train, evaluate, render, view},
          .value = shorthand(s.background, background_kind::white),
          .help = "Short for --background white",
          .excludes = {"--background"},
          .is_recorded = false}});
}

rows pose_options(settings& s) {
    return grouped(
        "Camera poses of photos",
        {{.names = "--poses",
          .commands = {train},
          .value = choice(s.poses),
          .help =
              "Source of the camera poses: given reads them with the scene; auto takes a folder of photos "
              "or a video as SCENE, computes them with COLMAP, and keeps them in the folder colmap of "
              "--output for the next run"},
         {.names = "--video-frames",
          .commands = {train},
          .value = whole(s.video_frames, poses::least_video_frames, poses::most_video_frames),
          .help = "Number of frames that --poses auto takes from a video: the sharpest of each part of it",
          .unit = "frames",
          .default_text = std::to_string(poses::default_video_frames),
          .needs = {"--poses"}},
         {.names = "--save-cameras",
          .commands = {train},
          .value = flag(s.save_cameras),
          .help = "Writes a COLMAP model with the learned poses to cameras/sparse/0",
          .is_rare = true}});
}

rows output_options(settings& s) {
    return grouped("Output", {{.names = "-o,--output,-m,--model-path",
                               .commands = {train},
                               .value = text(s.output, "FOLDER"),
                               .help = "Folder for the model, its measures and held-out renders",
                               .required = {train}},
                              {.names = "-o,--output",
                               .commands = {evaluate},
                               .value = text(s.output, "FOLDER"),
                               .help = "Folder for the metrics and the renders",
                               .default_text = "none; nothing is written"},
                              {.names = "-o,--output",
                               .commands = {render},
                               .value = text(s.output, "FOLDER"),
                               .help = "Folder for the renders, or a video with the ending .mp4",
                               .required = {render}},
                              {.names = "-o,--output",
                               .commands = {inspect},
                               .value = text(s.output, "FILE"),
                               .help = "JSON file for the findings",
                               .default_text = "none; nothing is written"},
                              {.names = "--save-iterations",
                               .commands = {train},
                               .value = iterations(s.save_iterations),
                               .help = "Iterations after which the model is saved, besides the last one",
                               .default_text = "none"},
                              {.names = "--overwrite",
                               .commands = {train},
                               .value = flag(s.overwrite),
                               .help = "Replaces the earlier run in the output folder",
                               .excludes = {"--resume"},
                               .is_recorded = false},
                              {.names = "--orbit-views",
                               .commands = {render},
                               .value = whole(s.orbit_views, 1, 10000),
                               .help = "Number of renders on an orbit, if they are images",
                               .unit = "images",
                               .excludes = {"--path", "--seconds"}},
                              {.names = "--log-level",
                               .commands = {train, evaluate, render, convert, view},
                               .value = choice(s.log_level),
                               .help = "Least important messages to print"},
                              {.names = "-q,--quiet",
                               .commands = {train, evaluate, render, convert, view},
                               .value = shorthand(s.log_level, log_level::error),
                               .help = "Short for --log-level error",
                               .excludes = {"--log-level"},
                               .is_recorded = false},
                              {.names = config_option,
                               .commands = {train},
                               .value = text(s.config, "FILE"),
                               .help = "JSON file with further options, such as the settings.json of a run; "
                                       "options of the command line override it",
                               .default_text = "none",
                               .is_recorded = false}});
}

rows run_options(settings& s) {
    return grouped(
        "Device and reproducibility",
        {{.names = "--device",
          .commands = {train, evaluate, render, convert, view},
          .value = choice(s.device),
          .help = "Device; auto takes a GPU if there is one"},
         {.names = "--seed",
          .commands = {train, evaluate, render},
          .value = whole(s.seed, 0, std::numeric_limits<std::uint64_t>::max()),
          .help = "Random seed"},
         {.names = "--deterministic",
          .commands = {train},
          .value = flag(s.deterministic),
          .help = "Makes runs with the same seed write the same bits; training takes longer"},
         {.names = "--gpus",
          .commands = {train},
          .value = count_or_all(s.gpus, ranks::most_ranks),
          .help = "Number of GPUs that train together",
          .is_recorded = false},
         {.names = "--ranks",
          .commands = {train},
          .value = whole(s.ranks, 1, ranks::most_ranks),
          .help = "Number of processes that train the model together on the CPU; they share the threads",
          .is_rare = true,
          .is_recorded = false},
         {.names = "--mpi",
          .commands = {train},
          .value = flag(s.mpi),
          .help = "Trains one model in the processes that mpirun or srun has started",
          .is_recorded = false}});
}

rows checkpoint_options(settings& s) {
    return grouped(
        "Checkpoints",
        {{.names = "--resume",
          .commands = {train},
          .value = flag(s.resume),
          .help = "Continues the run in the output folder from its newest checkpoint that is not damaged, or "
                  "begins if there is none; options may change",
          .is_recorded = false},
         {.names = "--checkpoint-every",
          .commands = {train},
          .value = whole(s.checkpoint_every, 1, most_iterations),
          .help = "Iterations between two checkpoints; Ctrl-C and SIGTERM make one, too",
          .unit = "iterations",
          .default_text = "none"},
         {.names = "--checkpoint-iterations",
          .commands = {train},
          .value = iterations(s.checkpoint_iterations),
          .help = "Iterations after which a checkpoint is made",
          .default_text = "none",
          .is_rare = true},
         {.names = "--keep-checkpoints",
          .commands = {train},
          .value = whole(s.keep_checkpoints, 1, 1000000),
          .help = "Number of checkpoints to keep; older ones are removed",
          .unit = "checkpoints",
          .is_rare = true}});
}

rows effect_options(settings& s) {
    std::string names;
    for (const std::string& name : effect_names()) names += (names.empty() ? "" : ", ") + name;
    return grouped(
        "Effects and colors",
        {
            {.names = "--effects",
             .commands = {train},
             .value = effect_list(s.effects),
             .help = "Effects to simulate: auto (see inspect), all, none, or names (" + names +
                     "); auto,+exposure,-sky adds one and omits another"},
            {.names = "--sh-degree",
             .commands = {train},
             .value = whole(s.sh_degree, 0, 3),
             .help = "Degree of the spherical harmonics (SH) of view-dependent colors",
             .default_text = "chosen by --effects"},
            {.names = "--sh-degree-interval",
             .commands = {train},
             .value = whole(s.schedule.sh_degree_interval, 1, most_iterations),
             .help = "Iterations between two increases of the SH degree",
             .unit = "iterations",
             .is_rare = true},
            {.names = "--sh-update-interval",
             .commands = {train},
             .value = whole(s.schedule.sh_update_interval, 1, most_iterations),
             .help = "Iterations between two updates of the SH coefficients of degree 1 and higher",
             .unit = "iterations",
             .is_rare = true},
        });
}

rows learning_rate_options(settings& s) {
    train::schedule& plan = s.schedule;
    const auto rate = [&](const char* name, auto& member, const char* help, const char* default_text = "") {
        return option{.names = name,
                      .commands = {train},
                      .value = positive(member),
                      .help = help,
                      .default_text = default_text,
                      .is_rare = true};
    };
    return grouped("Loss and learning rates of Adam",
                   {{.names = "--loss",
                     .commands = {train},
                     .value = word(s.loss, train::loss_names()),
                     .help = "Measure of the difference between a render and its photo that training "
                             "minimizes"},
                    rate("--position-lr-init", plan.position_lr_init,
                         "Learning rate of positions in the first iteration, relative to the scene's extent",
                         "1.6e-4, or 3.2e-4 if photos have transparent parts"),
                    rate("--position-lr-final", plan.position_lr_final,
                         "Learning rate of positions in the last iteration, relative to the scene's extent",
                         "1.6e-6, or 8e-6 if photos have transparent parts"),
                    rate("--feature-lr", plan.feature_lr, "Learning rate of base colors (SH degree 0)"),
                    rate("--sh-lr", plan.sh_lr, "Learning rate of view-dependent colors (SH degrees 1 to 3)",
                         "a tenth of --feature-lr, or a fifth if photos have transparent parts"),
                    rate("--opacity-lr", plan.opacity_lr, "Learning rate of opacities"),
                    rate("--scaling-lr", plan.scaling_lr, "Learning rate of the logarithms of scales"),
                    rate("--rotation-lr", plan.rotation_lr, "Learning rate of rotation quaternions"),
                    {.names = "--dropout",
                     .commands = {train},
                     .value = share(plan.dropout),
                     .help = "Share of the Gaussians that each step leaves out at random (Park et al. 2025)",
                     .default_text = "0.05, or 0 if photos have transparent parts"}});
}

rows densification_options(settings& s) {
    return grouped("Densification",
                   {{.names = "--init",
                     .commands = {train},
                     .value = choice(s.init),
                     .help = "Source of the first Gaussians: given takes the scene's points, stereo compares "
                             "photos, and auto adds points of stereo to few given ones",
                     .is_rare = true},
                    {.names = "--strategy",
                     .commands = {train},
                     .value = word(s.densification.name, train::strategy_settings::names()),
                     .help = "Densification strategy: decides which Gaussians training adds and removes"},
                    {.names = "--max-cap",
                     .commands = {train},
                     .value = whole(s.max_cap, 1, 300000000),
                     .help = "Largest number of Gaussians",
                     .unit = "Gaussians",
                     .default_text = "one for every 32 pixels of the training photos, at least 10000"}});
}

/// The options of the densification strategies.
rows strategy_options(settings& s) {
    rows all;
    s.densification.for_each([&](auto& config) {
        for (option& row : config.options()) {
            row.commands = {train};
            row.strategy = config.name;
            row.is_rare = true;
            row.group = "Densification strategy " + row.strategy;
            all.push_back(std::move(row));
        }
    });
    return all;
}

rows evaluation_options(settings& s) {
    rows table{{.names = "--test-iterations",
                .commands = {train},
                .value = iterations(s.test_iterations),
                .help = "Iterations after which the held-out views are measured, besides the last one",
                .default_text = "none",
                .needs = {"--eval"}}};
    // Training measures held-out views only; `evaluate` without --eval measures all views.
    const auto of_views = [&](option row) {
        row.commands = {train};
        row.needs = {"--eval"};
        table.push_back(row);
        row.commands = {evaluate};
        row.needs = {};
        table.push_back(row);
    };
    of_views({.names = "--fit-exposure",
              .value = flag(s.fit_exposure),
              .help = "Fits exposures on left halves of held-out views, and measures right ones, too"});
    of_views({.names = "--lpips",
              .value = text(s.lpips, "FILE"),
              .help = "Adds LPIPS, with weights of scripts/convert_lpips_weights.py",
              .default_text = "none"});
    return grouped("Evaluation", table);
}

}  // namespace

std::vector<option> option_table(settings& s) {
    rows table;
    for (auto& group :
         {model_options(s), scene_options(s), pose_options(s), output_options(s), page_options(s),
          video_options(s), view_options(s), checkpoint_options(s),
          grouped("Length and resolution", length_options(s)), effect_options(s), learning_rate_options(s),
          densification_options(s), strategy_options(s), grouped("Memory", memory_options(s)),
          evaluation_options(s), convert_options(s), run_options(s)})
        table.insert(table.end(), group.begin(), group.end());
    return table;
}

std::vector<option> rows_of(command c, const std::vector<option>& table) {
    rows of_command;
    std::ranges::copy_if(table, std::back_inserter(of_command),
                         [=](const option& o) { return o.belongs_to(c); });
    return of_command;
}

std::string purpose_of(command c) {
    switch (c) {
        case train:
            return "Trains Gaussians on the photos of a scene";
        case evaluate:
            return "Measures a saved model on the held-out views of a scene, or without --eval on all views";
        case render:
            return "Draws a saved model from the cameras of a scene or from an orbit";
        case convert:
            return "Converts a saved model to another format, and can crop, thin out or turn it";
        case compare:
            return "Writes a web page that compares several runs of train";
        case view:
            return "Shows a saved model in a browser";
        case inspect:
            return "Reports which effects the photos of a scene need";
        case doctor:
            return "Reports what this machine has, and how to get what is missing";
    }
    return "";
}

}  // namespace gs::cli
