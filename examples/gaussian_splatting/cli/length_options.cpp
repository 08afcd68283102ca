// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "length_options.hpp"

#include <string>

namespace gs::cli {

namespace {

using namespace options;

/// A number of iterations, or a plan of it that changes: see `iteration_plan::parse`.
option_value planned_iterations(iteration_plan& member) {
    constexpr int most = static_cast<int>(most_iterations);
    const std::string range = "1 to " + std::to_string(most);
    return {.type = "INTEGER",
            .range = range,
            .read =
                [=, &member](const std::string& word) {
                    const auto plan = iteration_plan::parse(word, most);
                    if (!plan)
                        throw refused_word("must be a whole number from " + range +
                                           " or a plan such as 7000,100:6500, not '" + word + "'");
                    member = *plan;
                },
            .json =
                [&member] {
                    return member.is_corrected() ? nlohmann::ordered_json(member.text())
                                                 : nlohmann::ordered_json(member.last());
                }};
}

}  // namespace

std::vector<option> length_options(settings& s) {
    using enum command;
    return {
        {.names = "-i,--iterations",
         .commands = {train},
         .value = planned_iterations(s.schedule.iterations),
         .help = "Number of iterations; a plan such as 7000,100:6500 in settings.json changes "
                 "it to 6500 after iteration 100",
         .unit = "iterations"},
        {.names = "--seconds",
         .commands = {train},
         .value = positive(s.seconds),
         .help = "Time of training, without loading and evaluation: chooses the number of iterations by "
                 "the speed of this machine",
         .unit = "seconds",
         .default_text = "none; --iterations decides",
         .excludes = {"--iterations"}},
        {.names = "--batch-size",
         .commands = {train},
         .value = whole(s.batch_size, 1, 64),
         .help = "Number of photos of each iteration; with several, learning rates grow like its square root",
         .is_rare = true},
        {.names = "--quality",
         .commands = {train},
         .value = choice(s.quality),
         .help = "Preset: fast takes less time, best takes more time for more detail; explicit options "
                 "override the preset"},
        {.names = "--num-downscales",
         .commands = {train},
         .value = whole(s.num_downscales, 0, 8),
         .help = "Number of times that the photos are halved at the start of training",
         .default_text = "one to three times, as long as 30000 pixels remain"},
        {.names = "--resolution-schedule",
         .commands = {train},
         .value = whole(s.schedule.resolution_schedule, 1, most_iterations),
         .help = "Iterations until the photos are halved once less",
         .unit = "iterations",
         .default_text = "6/5, 3/4 or 8/15 of the default of --densify-until-iter for --num-downscales 1, 2 "
                         "or 3; 2/5, 1/3 or 2/7 of it for rendered images",
         .is_rare = true}};
}

}  // namespace gs::cli
