// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "../features/feature.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "report.hpp"

namespace gs::cli {

void inspect(const settings& s) {
    const command_context context(s);
    const scene scene = context.load();
    const scene_statistics statistics(scene);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const auto& feature : features::all_features()) {
        const features::finding found = feature->analyze(statistics);
        const std::string name(feature->name()), costs_and_gains(feature->costs_and_gains());
        std::printf("%-14s %-4s %s\n%19s -> %s; %s\n", name.c_str(),
                    !found.recommended   ? "?"
                    : *found.recommended ? "yes"
                                         : "no",
                    found.evidence.c_str(), "", found.choice.c_str(), costs_and_gains.c_str());
        all.push_back(
            {{"name", name},
             {"recommended", found.recommended ? nlohmann::ordered_json(*found.recommended) : nullptr},
             {"evidence", found.evidence},
             {"choice", found.choice},
             {"expected", costs_and_gains}});
    }
    if (!s.output.empty()) write_json(s.output, {{"data", s.scene.data}, {"effects", all}});
}

}  // namespace gs::cli
