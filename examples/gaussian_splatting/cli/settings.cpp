// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "settings.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "../core/error.hpp"
#include "../densify/adaptive/adaptive_schedule.hpp"
#include "apply_quality_preset.hpp"

namespace gs::cli {

namespace {

/// Levenshtein's distance.
std::size_t edits_between(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
            diagonal = above;
        }
    }
    return row.back();
}

/// CLI11 would say that an option was not expected; we say which one was meant.
void refuse_unknown(const CLI::App& command, const std::vector<std::string>& arguments) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        for (const std::string& name : option->get_snames()) known.push_back("-" + name);
    }
    for (const std::string& argument : arguments) {
        const bool is_long = argument.starts_with("--");
        const bool is_short =
            !is_long && argument.size() > 1 && argument[0] == '-' && std::isalpha(argument[1]) != 0;
        if (argument == "--" || (!is_long && !is_short)) continue;
        const std::string name = is_long ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
        if (std::ranges::find(known, name) != known.end()) continue;
        const auto nearest =
            std::ranges::min_element(known, {}, [&](const std::string& k) { return edits_between(k, name); });
        throw error("unknown option " + name + " of " + command.get_name() + "; the nearest known one is " +
                    *nearest);
    }
}

/// CLI11 would say that a command is missing, whatever stands in its place.
void require_command(const CLI::App& app, const std::vector<CLI::App*>& commands,
                     const std::vector<std::string>& arguments) {
    std::string names;
    for (const CLI::App* command : commands) names += (names.empty() ? "" : ", ") + command->get_name();
    if (arguments.empty()) throw error("a command is missing: there are " + names + " (see --help)");
    const std::string& first = arguments.front();
    const auto is_first = [&](const CLI::App* command) { return command->get_name() == first; };
    if (std::ranges::any_of(commands, is_first) || app.get_option_no_throw(first) != nullptr) return;
    throw error("the command comes first, and '" + first + "' is none: there are " + names + " (see --help)");
}

/// CLI11's own checks print bounds as doubles do, and take -1 for the largest unsigned number.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
    const std::string range = std::to_string(least) + " to " + std::to_string(most);
    const auto refusal = [=](const std::string& text) {
        std::uint64_t value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = problem == std::errc() && end == text.data() + text.size();
        return whole && value >= least && value <= most
                   ? std::string()
                   : "must be a whole number from " + range + ", not '" + text + "'";
    };
    return {refusal, range};
}

/// CLI11's own check lets nan pass.
CLI::Validator positive_number(std::optional<int> below = {}) {
    const auto refusal = [below](const std::string& text) {
        float value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool number = problem == std::errc() && end == text.data() + text.size();
        const std::string limit = below ? "below " + std::to_string(*below) : "that float can hold";
        return number && std::isfinite(value) && value > 0 && (!below || value < static_cast<float>(*below))
                   ? std::string()
                   : "must be a positive number " + limit + ", not '" + text + "'";
    };
    return {refusal, "positive"};
}

CLI::Validator share() {
    const auto refusal = [](const std::string& text) {
        float value = -1;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool number = problem == std::errc() && end == text.data() + text.size();
        return number && value >= 0 && value < 1 ? std::string()
                                                 : "must be a number from 0 to below 1, not '" + text + "'";
    };
    return {refusal, "0 to below 1"};
}

void add_scene(CLI::App& app, settings& s, bool required) {
    auto* data = app.add_option("-d,--data,-s,--source-path", s.scene.data,
                                "Scene: a folder (COLMAP or Blender) or synthetic:NAME[,PARAMETER=VALUE...]");
    if (required) data->required();
    app.add_option("--images", s.scene.images, "Folder of the photos, below the scene's (COLMAP)")
        ->capture_default_str();
    app.add_option("-r,--resolution", s.scene.resolution,
                   "1, 2, 4, 8 divide the size; else the longer side in pixels")
        ->check(whole_number(1, 65536))
        ->capture_default_str();
    auto* eval = app.add_flag("--eval", s.scene.eval, "Hold out test views");
    app.add_option("--test-every", s.scene.test_every, "Hold out every n-th view (COLMAP)")
        ->check(whole_number(2, 1000000))
        ->needs(eval)
        ->capture_default_str();
}

void add_common(CLI::App& app, settings& s) {
    app.add_option("--device", s.device, "Where to compute")
        ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
        ->capture_default_str();
    auto* background = app.add_option("--background", s.background,
                                      "Behind everything: auto is white for photos with alpha, else black")
                           ->check(CLI::IsMember({"auto", "white", "black", "random"}))
                           ->capture_default_str();
    app.add_flag_callback(
           "-w,--white-background", [&s] { s.background = "white"; }, "The same as --background white")
        ->excludes(background);
    app.add_option("--seed", s.seed, "Of everything random")
        ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
        ->capture_default_str();
    app.add_flag("-q,--quiet", s.quiet, "Print errors only");
}

/// The rates and intervals, by the names that the field gives them.
void add_schedule(CLI::App& app, train::schedule& s, train::adaptive_config& adaptive) {
    const auto rate = [&](const char* name, double& value, const char* what) {
        app.add_option(name, value, what)->check(positive_number())->capture_default_str();
    };
    const auto count = [&](const char* name, int& value, std::uint64_t least, const char* what) {
        app.add_option(name, value, what)->check(whole_number(least, 10000000))->capture_default_str();
    };
    rate("--position-lr-init", s.position_lr_init,
         "Adam's rate of positions at first, by the scene's extent");
    rate("--position-lr-final", s.position_lr_final, "The same at the end");
    rate("--feature-lr", s.feature_lr, "Of colours");
    app.add_option("--sh-lr", s.sh_lr,
                   "Of colours that depend on direction; by default a tenth of --feature-lr")
        ->check(positive_number());
    rate("--opacity-lr", s.opacity_lr, "Of opacities");
    rate("--scaling-lr", s.scaling_lr, "Of log scales");
    rate("--rotation-lr", s.rotation_lr, "Of quaternions");
    count("--opacity-reset-interval", adaptive.opacity_reset_interval, 1,
          "Iterations between two resets; none in densification's last interval, but for the first on white");
    count("--densification-interval", adaptive.densification_interval, 1,
          "Iterations between two densifications");
    count("--densify-from-iter", adaptive.densify_from_iter, 0, "Densify after this iteration");
    app.add_option("--densify-until-iter", adaptive.densify_until_iter,
                   "And before this one; by default half of the iterations, at most 15000")
        ->check(whole_number(0, 10000000));
    app.add_option("--num-downscales", s.num_downscales, "How often photos are halved at first")
        ->check(whole_number(0, 8))
        ->capture_default_str();
    app.add_option(
           "--resolution-schedule", s.resolution_schedule,
           "Iterations until they are halved once less, and again once less; by default a fifth of all "
           "if photos are halved once")
        ->check(whole_number(1, 10000000));
    count("--sh-update-interval", s.sh_update_interval, 1,
          "Iterations between two steps of colours that depend on direction");
    app.add_option("--prune-share", adaptive.prune_share,
                   "Of the Gaussians, those that matter least are dropped when densification has ended; by "
                   "default 0.2 if it grew any, but 0 with --budget")
        ->check(share());
}

CLI::Option* add_fit_exposure(CLI::App& app, settings& s) {
    return app.add_flag(
        "--fit-exposure", s.fit_exposure,
        "Measure the right halves of test photos, too, after fitting the exposure on the left ones");
}

CLI::App* add_train(CLI::App& app, settings& s) {
    CLI::App* train = app.add_subcommand("train", "Photos to Gaussians");
    add_scene(*train, s, true);
    add_common(*train, s);
    train->add_option("-o,--output,-m,--model-path", s.output, "Folder for the results")->required();
    train
        ->add_option(
            "--quality", s.quality,
            "fast: 5000 iterations, and faster colours; best: 30000, and more Gaussians; what is said wins")
        ->check(CLI::IsMember({"fast", "balanced", "best"}))
        ->capture_default_str();
    train->add_option("-i,--iterations", s.schedule.iterations)
        ->check(whole_number(1, 10000000))
        ->capture_default_str();
    train
        ->add_option_function<std::string>(
            "--effects",
            [&s](const std::string& text) {
                s.effects = effects::parse_selection(text);
                s.scene.masks = s.effects.takes(effects::effect::masks);
                s.scene.depths = s.effects.takes(effects::effect::depth);
            },
            "What to simulate: auto is what the scene calls for (see inspect), all, none, or some of "
            "direction, exposure, antialiasing, sky, masks and depth; auto,+exposure,-direction adds and "
            "leaves out")
        ->default_str("auto");
    train->add_option("--sh-degree", s.sh_degree, "Of view-dependent colour; by default as --effects has it")
        ->check(whole_number(0, 3));
    train->add_option("--sh-degree-interval", s.schedule.sh_degree_interval, "Iterations between two degrees")
        ->check(whole_number(1, 10000000))
        ->capture_default_str();
    train
        ->add_option(
            "--densify-grad-threshold", s.densification.adaptive.densify_grad_threshold,
            "Mean gradient of a centre, in halves of the picture, from which a Gaussian grows; by default "
            "8e-5 for 30000 iterations, and more for fewer")
        ->check(positive_number());
    add_schedule(*train, s.schedule, s.densification.adaptive);
    train->add_option("--max-cap", s.max_cap, "Most Gaussians; by default one for 32 pixels of the photos")
        ->check(whole_number(1, 100000000));
    train
        ->add_option("--budget", s.densification.adaptive.budget,
                     "Gaussians to grow to, evenly and the most urgent first, whatever their gradients")
        ->check(whole_number(1, 100000000))
        ->excludes(train->get_option("--densify-grad-threshold"));
    train->add_flag("--revised-opacity,!--no-revised-opacity", s.densification.adaptive.revised_opacity,
                    "A copied Gaussian and its copy are together as opaque as it was alone");
    train->add_flag(
        "--deterministic", s.deterministic,
        "The same bits in the .ply from the same seed, run after run, with any number of threads");
    add_fit_exposure(*train, s)->needs(train->get_option("--eval"));
    train->add_option("--save-iterations", s.save_iterations, "Save the model then, too");
    train->add_option("--test-iterations", s.test_iterations, "Measure the test views then, too")
        ->needs(train->get_option("--eval"));
    return train;
}

CLI::App* add_evaluate(CLI::App& app, settings& s) {
    CLI::App* evaluate = app.add_subcommand("evaluate", "Measure a saved model on a scene's test views");
    evaluate->add_option("ply", s.ply, "The model")->required();
    add_scene(*evaluate, s, true);
    add_common(*evaluate, s);
    add_fit_exposure(*evaluate, s);
    evaluate->add_flag("!--no-masks", s.scene.masks, "Measure what masks leave out, too");
    evaluate->add_option("-o,--output", s.output,
                         "Folder for metrics.json and the pictures; none are kept without");
    return evaluate;
}

CLI::App* add_render(CLI::App& app, settings& s) {
    CLI::App* render =
        app.add_subcommand("render", "Draw a saved model, from a scene's cameras or from an orbit");
    render->add_option("ply", s.ply, "The model")->required();
    add_scene(*render, s, false);
    add_common(*render, s);
    render->add_option("-o,--output", s.output, "Folder for the pictures")->required();
    render->get_option("--images")->needs("--data");
    render->get_option("--test-every")->needs("--data");
    render->add_option("--orbit-views", s.orbit_views, "Without --data: pictures of the orbit")
        ->check(whole_number(1, 10000))
        ->excludes(render->get_option("--data"))
        ->capture_default_str();
    return render;
}

CLI::App* add_inspect(CLI::App& app, settings& s) {
    CLI::App* inspect = app.add_subcommand("inspect", "What a scene's photos call for");
    add_scene(*inspect, s, true);
    inspect->add_option("-o,--output", s.output, "A JSON file");
    return inspect;
}

void refuse_late(const std::set<int>& iterations, int last, const std::string& option) {
    for (const int i : iterations)
        if (i < 1 || i > last)
            throw error(option + " names iteration " + std::to_string(i) +
                        ", but there are only iterations 1 to " + std::to_string(last));
}

void refuse_endless_shrinking(const train::schedule& s) {
    const std::int64_t until = std::int64_t{s.num_downscales} * s.resolution_interval();
    if (s.num_downscales > 0 && until >= s.iterations)
        throw error("--num-downscales " + std::to_string(s.num_downscales) + " with --resolution-schedule " +
                    std::to_string(s.resolution_interval()) + " comes to whole photos after iteration " +
                    std::to_string(until) + ", but there are only " + std::to_string(s.iterations));
}

void refuse_pruning_at_no_time(const settings& s) {
    const int iterations = s.schedule.iterations;
    const train::adaptive_schedule plan(s.densification.adaptive, {.iterations = iterations});
    if (plan.share_to_prune() > 0 && plan.densify_until() >= iterations)
        throw error("--prune-share is dropped after densification, which --densify-until-iter ends at " +
                    std::to_string(plan.densify_until()) + ", but there are only " +
                    std::to_string(iterations) + " iterations");
}

void refuse_large_budget(const settings& s) {
    const std::size_t budget = s.densification.adaptive.budget;
    if (s.max_cap > 0 && budget > s.max_cap)
        throw error("--budget " + std::to_string(budget) + " is more than --max-cap " +
                    std::to_string(s.max_cap));
}

}  // namespace

settings parse(int argc, char** argv) {
    settings s;
    CLI::App app("3D Gaussian splatting: from photos to a .ply, on a CPU or a GPU.", "gaussian_splatting");
    app.require_subcommand(1);
    app.set_version_flag("--version", WARPAGG_VERSION);
    const std::vector<CLI::App*> commands{add_train(app, s), add_evaluate(app, s), add_render(app, s),
                                          add_inspect(app, s)};

    std::vector<std::string> arguments(argv + 1, argv + argc);
    for (std::string& a : arguments)
        if (a.starts_with("--"))
            std::replace(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.find('='), a.size())),
                         '_', '-');
    require_command(app, commands, arguments);
    for (const CLI::App* command : commands)
        if (arguments[0] == command->get_name()) refuse_unknown(*command, arguments);
    try {
        std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // as CLI11 wants them
        app.parse(reversed);
    } catch (const CLI::Success& asked) {
        std::exit(app.exit(asked));
    } catch (const CLI::ParseError& wrong) {
        throw error(std::string(wrong.what()) + " (see --help)");
    }
    s.command = app.get_subcommands().front()->get_name();
    s.scene.seed = s.seed;
    choose_quality(*app.get_subcommand("train"), s.quality);
    train::adaptive_config& adaptive = s.densification.adaptive;
    if (adaptive.budget > 0 && !adaptive.prune_share) adaptive.prune_share = 0;
    if (s.command != "train" && s.background == "random")
        throw error("--background random is for training: " + s.command + " needs one colour");
    refuse_late(s.save_iterations, s.schedule.iterations, "--save-iterations");
    refuse_late(s.test_iterations, s.schedule.iterations, "--test-iterations");
    refuse_endless_shrinking(s.schedule);
    refuse_pruning_at_no_time(s);
    refuse_large_budget(s);
    if (s.command == "render") s.scene.masks = false;  // its photos are not looked at
    if (s.command == "render" || s.command == "evaluate") s.scene.depths = false;
    if (s.command == "render" && s.scene.data.empty() && s.scene.eval)
        throw error("--eval picks views of a scene: it needs --data");
    return s;
}

}  // namespace gs::cli
