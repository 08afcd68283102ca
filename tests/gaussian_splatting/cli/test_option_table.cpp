// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "cli/check_settings.hpp"
#include "cli/help.hpp"
#include "cli/option_table.hpp"
#include "cli/parse.hpp"
#include "cli/training_report.hpp"

using namespace gs::cli;
using gs_test::says;
using words = std::vector<std::string>;

namespace {

/// A value that is not the default, and whether it has reached the setting.
struct option_case {
    words value;
    std::function<bool(const settings&)> has_arrived;
    words before{};  ///< given before the option
    bool is_only_value = false;
};

const gs::train::adaptive_config& adaptive(const settings& s) {
    return s.densification.of<gs::train::adaptive_config>();
}
const gs::train::mcmc_config& mcmc(const settings& s) { return s.densification.of<gs::train::mcmc_config>(); }

const gs::train::error_config& by_error(const settings& s) {
    return s.densification.of<gs::train::error_config>();
}

std::string config_with_seed_7() {
    static const gs_test::temporary_folder folder;
    gs_test::write_file(folder / "config.json", R"({"seed": 7})");
    return folder / "config.json";
}

/// Indexed by name, without second names of the same option.
const std::map<std::string, option_case> cases{
    {"ply", {{"a.ply"}, [](const settings& s) { return s.ply == "a.ply"; }}},
    {"runs",
     {{"a", "b"},
      [](const settings& s) {
          return s.runs == words{"a", "b"};
      }}},
    {"--data", {{"a scene"}, [](const settings& s) { return s.scene.data == "a scene"; }}},
    {"--images", {{"photos"}, [](const settings& s) { return s.scene.images == "photos"; }}},
    {"--poses", {{"auto"}, [](const settings& s) { return s.poses == pose_source::automatic; }}},
    {"--video-frames", {{"80"}, [](const settings& s) { return s.video_frames == 80; }}},
    {"--resolution", {{"640"}, [](const settings& s) { return s.scene.resolution == 640; }}},
    {"--eval", {{}, [](const settings& s) { return s.scene.eval; }}},
    {"--test-every", {{"5"}, [](const settings& s) { return s.scene.test_every == 5; }}},
    {"--no-masks", {{}, [](const settings& s) { return !s.scene.masks; }}},
    {"--background", {{"black"}, [](const settings& s) { return s.background == background_kind::black; }}},
    {"--white-background", {{}, [](const settings& s) { return s.background == background_kind::white; }}},
    {"--output", {{"results"}, [](const settings& s) { return s.output == "results"; }}},
    {"--gpus", {{"all"}, [](const settings& s) { return s.gpus == 0; }}},
    {"--ranks", {{"3"}, [](const settings& s) { return s.ranks == 3; }}},
    {"--mpi", {{}, [](const settings& s) { return s.mpi; }}},
    {"--save-iterations",
     {{"30", "10"},
      [](const settings& s) {
          return s.save_iterations == std::set{10, 30};
      }}},
    {"--save-cameras", {{}, [](const settings& s) { return s.save_cameras; }}},
    {"--overwrite", {{}, [](const settings& s) { return s.overwrite; }}},
    {"--resume", {{}, [](const settings& s) { return s.resume; }}},
    {"--checkpoint-every", {{"5"}, [](const settings& s) { return s.checkpoint_every == 5; }}},
    {"--checkpoint-iterations",
     {{"30", "10"},
      [](const settings& s) {
          return s.checkpoint_iterations == std::set{10, 30};
      }}},
    {"--keep-checkpoints", {{"3"}, [](const settings& s) { return s.keep_checkpoints == 3; }}},
    {"--html", {{"page.html"}, [](const settings& s) { return s.html == "page.html"; }}},
    {"--no-viewer", {{}, [](const settings& s) { return s.no_viewer; }}},
    {"--viewer-size", {{"5MB"}, [](const settings& s) { return s.viewer_size == 5'000'000U; }}},
    {"input", {{"a.ply"}, [](const settings& s) { return s.ply == "a.ply"; }}},
    {"output", {{"b.spz"}, [](const settings& s) { return s.output == "b.spz"; }}},
    {"--crop",
     {{"3,2,1,-1,-2,-3"},
      [](const settings& s) {
          return s.crop && s.crop->least == glm::dvec3(-1, -2, -3) && s.crop->most == glm::dvec3(3, 2, 1);
      }}},
    {"--remove-floaters", {{}, [](const settings& s) { return s.remove_floaters; }}},
    {"--decimate", {{"12.5%"}, [](const settings& s) { return s.decimate && s.decimate->of(100) == 13; }}},
    {"--max-sh-degree", {{"1"}, [](const settings& s) { return s.export_options.max_sh_degree == 1; }}},
    {"--sky", {{"none"}, [](const settings& s) { return s.sky == sky_form::none; }}},
    {"--up", {{"-z"}, [](const settings& s) { return s.up == up_axis::minus_z; }}},
    {"--spz-version", {{"3"}, [](const settings& s) { return s.export_options.spz_version == 3; }}},
    {"--orbit-views", {{"3"}, [](const settings& s) { return s.orbit_views == 3; }}},
    {"--orbit", {{}, [](const settings& s) { return s.orbit; }}},
    {"--path", {{"path.json"}, [](const settings& s) { return s.camera_path == "path.json"; }}},
    {"--fps", {{"24"}, [](const settings& s) { return s.frames_per_second == 24; }}},
    {"--viewer", {{"8123"}, [](const settings& s) { return s.viewer == 8123; }}},
    {"--port", {{"8124"}, [](const settings& s) { return s.viewer == 8124; }}},
    {"--viewer-host", {{"::1"}, [](const settings& s) { return s.viewer_host == "::1"; }}},
    {"--quiet", {{}, [](const settings& s) { return s.log_level == log_level::error; }}},
    {"--log-level", {{"warning"}, [](const settings& s) { return s.log_level == log_level::warning; }}},
    {"--config", {{config_with_seed_7()}, [](const settings& s) { return s.seed == 7; }}},
    {"--iterations", {{"20"}, [](const settings& s) { return s.schedule.iterations == 20; }}},
    {"--batch-size", {{"4"}, [](const settings& s) { return s.batch_size == 4; }}},
    {"--seconds", {{"90.5"}, [](const settings& s) { return s.seconds == 90.5; }}},
    {"--quality", {{"best"}, [](const settings& s) { return s.quality == quality_preset::best; }}},
    {"--num-downscales", {{"2"}, [](const settings& s) { return s.num_downscales == 2; }}},
    {"--resolution-schedule", {{"7"}, [](const settings& s) { return s.schedule.resolution_schedule == 7; }}},
    {"--effects", {{"none,+sky"}, [](const settings& s) { return s.effects.text == "none,+sky"; }}},
    {"--sh-degree", {{"2"}, [](const settings& s) { return s.sh_degree == 2; }}},
    {"--sh-degree-interval", {{"50"}, [](const settings& s) { return s.schedule.sh_degree_interval == 50; }}},
    {"--sh-update-interval", {{"4"}, [](const settings& s) { return s.schedule.sh_update_interval == 4; }}},
    {"--position-lr-init", {{"1e-3"}, [](const settings& s) { return s.schedule.position_lr_init == 1e-3; }}},
    {"--position-lr-final",
     {{"1e-5"}, [](const settings& s) { return s.schedule.position_lr_final == 1e-5; }}},
    {"--feature-lr", {{"2e-3"}, [](const settings& s) { return s.schedule.feature_lr == 2e-3; }}},
    {"--sh-lr", {{"3e-4"}, [](const settings& s) { return s.schedule.sh_lr == 3e-4; }}},
    {"--opacity-lr", {{"3e-2"}, [](const settings& s) { return s.schedule.opacity_lr == 3e-2; }}},
    {"--scaling-lr", {{"4e-3"}, [](const settings& s) { return s.schedule.scaling_lr == 4e-3; }}},
    {"--rotation-lr", {{"5e-3"}, [](const settings& s) { return s.schedule.rotation_lr == 5e-3; }}},
    {"--dropout", {{"0.2"}, [](const settings& s) { return s.schedule.dropout == 0.2; }}},
    {"--loss", {{"l1_ssim"}, [](const settings& s) { return s.loss == "l1_ssim"; }, {}, true}},
    {"--strategy", {{"mcmc"}, [](const settings& s) { return s.densification.name == "mcmc"; }}},
    {"--error-views",
     {{"3"}, [](const settings& s) { return by_error(s).views == 3; }, {"--strategy", "error"}}},
    {"--error-level",
     {{"0.2"}, [](const settings& s) { return by_error(s).level == 0.2; }, {"--strategy", "error"}}},
    {"--error-pixels",
     {{"4"}, [](const settings& s) { return by_error(s).pixels == 4; }, {"--strategy", "error"}}},
    {"--mcmc-noise", {{"0"}, [](const settings& s) { return mcmc(s).noise == 0; }, {"--strategy", "mcmc"}}},
    {"--mcmc-opacity-penalty",
     {{"0.5"}, [](const settings& s) { return mcmc(s).opacity_penalty == 0.5; }, {"--strategy", "mcmc"}}},
    {"--mcmc-scale-penalty",
     {{"1e-3"}, [](const settings& s) { return mcmc(s).scale_penalty == 1e-3; }, {"--strategy", "mcmc"}}},
    {"--densify-from-iter", {{"0"}, [](const settings& s) { return adaptive(s).densify_from_iter == 0; }}},
    {"--densify-until-iter", {{"9"}, [](const settings& s) { return adaptive(s).densify_until_iter == 9; }}},
    {"--densification-interval",
     {{"8"}, [](const settings& s) { return adaptive(s).densification_interval == 8; }}},
    {"--densify-grad-threshold",
     {{"1e-4"}, [](const settings& s) { return adaptive(s).densify_grad_threshold == 1e-4; }}},
    {"--budget", {{"900"}, [](const settings& s) { return adaptive(s).budget == 900; }}},
    {"--photo-memory", {{"2KiB"}, [](const settings& s) { return s.photo_memory == 2048; }}},
    {"--init", {{"stereo"}, [](const settings& s) { return s.init == gs::train::point_source::stereo; }}},
    {"--gpu-memory", {{"1.5GB"}, [](const settings& s) { return s.gpu_memory == 1500000000; }}},
    {"--precision",
     {{"compact"}, [](const settings& s) { return s.precision == gs::train::moment_precision::compact; }}},
    {"--max-cap", {{"1000"}, [](const settings& s) { return s.max_cap == 1000; }}},
    {"--opacity-reset-interval",
     {{"60"}, [](const settings& s) { return adaptive(s).opacity_reset_interval == 60; }}},
    {"--no-revised-opacity", {{}, [](const settings& s) { return !adaptive(s).revised_opacity; }}},
    {"--revised-opacity",
     {{}, [](const settings& s) { return adaptive(s).revised_opacity; }, {"--no-revised-opacity"}}},
    {"--opacity-penalty", {{"0.02"}, [](const settings& s) { return adaptive(s).opacity_penalty == 0.02; }}},
    {"--prune-share", {{"0.5"}, [](const settings& s) { return adaptive(s).prune_share == 0.5; }}},
    {"--test-iterations", {{"15"}, [](const settings& s) { return s.test_iterations == std::set{15}; }}},
    {"--fit-exposure", {{}, [](const settings& s) { return s.fit_exposure; }}},
    {"--lpips", {{"a file"}, [](const settings& s) { return s.lpips == "a file"; }}},
    {"--device", {{"cpu"}, [](const settings& s) { return s.device == device_kind::cpu; }}},
    {"--seed",
     {{"18446744073709551615"}, [](const settings& s) { return s.seed == 18446744073709551615ULL; }}},
    {"--deterministic", {{}, [](const settings& s) { return s.deterministic; }}}};

const option_case& case_of(const option& row, const std::string& name) {
    const auto own = cases.find(name);
    const auto found = own != cases.end() ? own : cases.find(row.name());
    if (found == cases.end()) FAIL("add a case for " << row.name());
    return found->second;
}

void append(words& all, const words& more) { all.insert(all.end(), more.begin(), more.end()); }

void append_option(words& all, const option& row, const std::string& name) {
    const option_case& c = case_of(row, name);
    append(all, c.before);
    if (!row.is_positional()) all.push_back(name);
    append(all, c.value);
}

/// The shortest command line that gives the option by this name.
words command_line(command c, const option& row, const std::string& name) {
    static settings unused;
    static const std::vector<option> table = option_table(unused);
    const auto needs = [](const option& some, const option& other) {
        return std::ranges::find(some.needs, other.name()) != some.needs.end();
    };
    const auto is_needed = [&](const option& other) {
        const bool indirectly = std::ranges::any_of(table, [&](const option& between) {
            return between.belongs_to(c) && needs(row, between) && needs(between, other);
        });
        return other.name() != row.name() &&
               (other.is_required_by(c) || needs(row, other) || indirectly ||
                (other.name() == "--data" && !row.needs.empty() && row.name() != "--data"));
    };
    words all{name_of(c)};
    for (const option& other : table) {
        if (!other.belongs_to(c)) continue;
        const bool is_in_its_place = row.is_positional() && other.name() == row.name();
        if (is_needed(other) || is_in_its_place) append_option(all, other, other.name());
    }
    if (!row.is_positional()) append_option(all, row, name);
    return all;
}

/// Calls `f(command, row)` for all options of all commands.
template <class F>
void for_each_option(const F& f) {
    settings defaults;
    for (const option& row : option_table(defaults))
        for (const command c : row.commands) {
            CAPTURE(name_of(c));
            CAPTURE(row.names);
            f(c, row);
        }
}

}  // namespace

TEST_CASE("every option is accepted by all its names and reaches its setting") {
    for_each_option([](command c, const option& row) {
        for (const std::string& name : row.all_names()) {
            CAPTURE(name);
            const option_case& expected = case_of(row, name);
            if (expected.before.empty() && !expected.is_only_value)
                CHECK_FALSE(expected.has_arrived(settings{}));
            CHECK(expected.has_arrived(parse(command_line(c, row, name))));

            std::string with_underscores = name;
            std::replace(with_underscores.begin() + 2, with_underscores.end(), '-', '_');
            words same = command_line(c, row, name);
            std::ranges::replace(same, name, with_underscores);
            CHECK(expected.has_arrived(parse(same)));
        }
    });
}

TEST_CASE("an unknown option is refused with the name of the nearest one") {
    for_each_option([](command c, const option& row) {
        if (row.is_positional()) return;
        words wrong = command_line(c, row, row.name());
        std::ranges::replace(wrong, row.name(), row.name() + "xx");
        std::string message;
        try {
            parse(wrong);
        } catch (const gs::error& e) {
            message = e.what();
        }
        CHECK(says(message, {"unknown option " + row.name() + "xx of " + name_of(c), "is " + row.name()}));
    });
}

TEST_CASE("an option of a densification strategy is refused beside another strategy") {
    const option row{.names = "--noise", .value = {}, .help = "", .strategy = "noisy"};
    CHECK_NOTHROW(check_belongs_to_strategy(row, "noisy"));
    CHECK_THROWS_WITH_AS(check_belongs_to_strategy(row, "adaptive"),
                         "--noise belongs to --strategy noisy, but the strategy is adaptive: leave it out or "
                         "choose that strategy",
                         gs::error);
    settings defaults;
    for (const option& known : option_table(defaults))
        CHECK((known.strategy.empty() || known.group == "Densification strategy " + known.strategy));
}

TEST_CASE("settings.json leaves out the options of other densification strategies") {
    settings s;
    CHECK(settings_json(s).contains("prune_share"));
    s.densification.name = "another";
    CHECK_FALSE(settings_json(s).contains("prune_share"));
    CHECK(settings_json(s).contains("max_cap"));
}

TEST_CASE("settings.json has every option of train and of its strategy exactly once") {
    for (const std::string& strategy : gs::train::strategy_settings::names()) {
        CAPTURE(strategy);
        std::set<std::string> expected;
        const auto recorded =
            settings_json(parse({"train", "-d", "a scene", "-o", "results", "--strategy", strategy}));
        for_each_option([&](command c, const option& row) {
            if (c != command::train || !row.is_recorded) return;
            if (!row.strategy.empty() && row.strategy != strategy) return;
            CHECK(expected.insert(row.key()).second);
            CHECK(recorded.contains(row.key()));
            if (row.is_required_by(c) || case_of(row, row.name()).is_only_value) return;
            if (row.name() == "--strategy") return;  // the loop over strategies tests it
            words line = command_line(c, row, row.all_names().back());
            if (std::ranges::find(line, "--strategy") == line.end()) append(line, {"--strategy", strategy});
            CHECK(settings_json(parse(line)).at(row.key()) != recorded.at(row.key()));
        });
        CHECK(recorded.size() == expected.size() + 1);
        CHECK(recorded.contains("given"));
    }
}

TEST_CASE("rows of the option table refer to options of the same command") {
    settings defaults;
    const std::vector<option> table = option_table(defaults);
    for_each_option([&](command c, const option& row) {
        for (const auto& others : {row.needs, row.excludes})
            for (const std::string& name : others)
                CHECK(std::ranges::any_of(
                    table, [&](const option& o) { return o.belongs_to(c) && o.name() == name; }));
        CHECK(std::ranges::count_if(
                  table, [&](const option& o) { return o.belongs_to(c) && o.name() == row.name(); }) == 1);
    });
}

TEST_CASE("the reference of the command line is up to date") {
    const std::string file = WARPAGG_SOURCE_DIR "/docs/reference/cli.md";
    INFO("to update it: gaussian_splatting --print-reference > " << file);
    CHECK(gs_test::read_file(file) == reference_page());
}

TEST_CASE("help: each option of a command appears under its group, and common ones have their description") {
    for_each_option([](command c, const option& row) {
        settings defaults;
        std::vector<option> rows;
        for (const option& other : option_table(defaults))
            if (other.belongs_to(c)) rows.push_back(other);
        const std::string text = help_text(c, rows);
        const std::string first_words = row.is_rare ? "" : row.help.substr(0, row.help.find(' ', 20));
        const std::string type = row.value.is_flag() || row.is_rare ? "" : " " + row.value.type;
        CHECK(says(text, {row.group + ":\n", row.name() + type, first_words}));
    });
}

TEST_CASE("help: no command needs more than two screens of 60 lines, or lines of more than 110 characters") {
    for (const command c : all_values<command>) {
        CAPTURE(name_of(c));
        settings defaults;
        std::vector<option> rows;
        for (const option& row : option_table(defaults))
            if (row.belongs_to(c)) rows.push_back(row);
        std::istringstream text(help_text(c, rows));
        int lines = 0;
        for (std::string line; std::getline(text, line); ++lines) CHECK(line.size() <= 110);
        CHECK(lines <= 120);
    }
}

TEST_CASE("the manual page has every name of every option") {
    const std::string page = man_page();
    for_each_option([&](command, const option& row) {
        for (std::string name : row.all_names()) {
            for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2)
                name.insert(at, 1, '\\');
            CAPTURE(name);
            CHECK(says(page, {name}));
        }
    });
}

TEST_CASE("--viewer takes a port or none") {
    const words train{"train", "-d", "a scene", "-o", "results"};
    const auto with = [&](words more) {
        more.insert(more.begin(), train.begin(), train.end());
        return parse(more).viewer;
    };
    CHECK_FALSE(with({}).has_value());
    CHECK(with({"--viewer"}) == 0);
    CHECK(with({"--viewer", "--seed", "3"}) == 0);
    CHECK(with({"--viewer", "8123"}) == 8123);
    CHECK_THROWS_AS(with({"--viewer", "65536"}), gs::error);
}
