// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The trainer's command `train` with two more options, for the cost of accuracy and of each rung of the
/// ladder. Writes both into metrics.json and settings.json.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/parse.hpp"
#include "core/error.hpp"
#include "core/write_json.hpp"
#include "engines.hpp"
#include "lab.hpp"
#include "lab/accumulator_set.hpp"

namespace gs::lab {

namespace {

constexpr const char* help =
    "  --gradient RUNG     Kernel of the backward blending: per-lane, reduce, reduce-skip, scatter or split\n"
    "                      (default: split, the trainer's)\n"
    "  --accumulate WAY    What memory keeps the sums of split in: native (default), f64, compensated,\n"
    "                      fixed, binned or exact\n"
    "\nThe other options are those of gaussian_splatting train:\n\n";

/// Removes `option` and its value from the arguments, and returns the value.
std::optional<std::string> take(std::vector<std::string>& arguments, const std::string& option) {
    for (auto at = arguments.begin(); at != arguments.end(); ++at) {
        if (at->starts_with(option + "=")) {
            const std::string value = at->substr(option.size() + 1);
            arguments.erase(at);
            return value;
        }
        if (*at != option) continue;
        if (at + 1 == arguments.end()) throw error(option + " needs a value");
        const std::string value = at[1];
        arguments.erase(at, at + 2);
        return value;
    }
    return {};
}

template <class Named>
accumulator find(const Named& known, const std::string& option, const std::string& name) {
    std::string names;
    for (const named_accumulator& k : known) {
        if (k.name == name) return k.value;
        names += (names.empty() ? "" : ", ") + std::string(k.name);
    }
    throw error(option + " must be one of " + names + ", not '" + name + "'");
}

void add_to_json(const std::filesystem::path& file, const nlohmann::ordered_json& more) {
    nlohmann::ordered_json json;
    std::ifstream(file) >> json;
    json.update(more);
    write_json(file, json);
}

}  // namespace

int train(int argc, char** argv) {
    std::vector<std::string> arguments(argv, argv + argc);
    const auto rung = take(arguments, "--gradient"), way = take(arguments, "--accumulate");
    if (rung && way) throw error("--accumulate is for --gradient split: give one of the two options");
    if (std::ranges::find(arguments, "--help") != arguments.end()) std::fputs(help, stdout);
    cli::settings s = cli::parse(arguments);
    if (s.deterministic && (rung || way))
        throw error("--deterministic means --accumulate fixed: give one option");
    const accumulator how = rung              ? find(ladder, "--gradient", *rung)
                            : way             ? find(accumulations, "--accumulate", *way)
                            : s.deterministic ? fixed
                                              : native;
    if (!lab_accumulators::supports_background_image(how)) {
        if (s.effects.explicit_choice("sky").value_or(false))
            throw error("only --gradient split and --accumulate fixed can train a sky");
        s.effects.explicit_choices["sky"] = false;
        s.effects.text += ",-sky";
    }
    ranks::communicator alone;
    cli::train(s, uses_gpu(cli::name_of(s.device)) ? make_cuda_engine() : make_cpu_engine(), how, alone);

    const std::string kept_in = way.value_or(s.deterministic ? "fixed" : "native");
    const nlohmann::ordered_json chosen{{"gradient", rung.value_or("split")}, {"accumulate", kept_in}};
    const std::filesystem::path output = s.output;
    add_to_json(output / "settings.json", chosen);
    add_to_json(output / "metrics.json", chosen);
    add_to_json(output / "metrics.json", {{"accumulator", kept_in}});
    return 0;
}

}  // namespace gs::lab
