// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "../features/decide.hpp"
#include "command_context.hpp"

namespace gs::cli {

void inspect(const settings& s) {
    const session session(s);
    const scene scene = session.load();
    const effects::evidence evidence = effects::gather(scene);
    nlohmann::ordered_json found = nlohmann::ordered_json::array();
    for (const effects::decision& d : effects::decide(evidence)) {
        std::printf("%-14s %-4s %s\n%19s -> %s; costs and gains: %s\n", d.name.c_str(),
                    !d.called_for   ? "?"
                    : *d.called_for ? "yes"
                                    : "no",
                    d.evidence.c_str(), "", d.choice.c_str(), d.expected.c_str());
        found.push_back({{"name", d.name},
                         {"called_for", d.called_for ? nlohmann::ordered_json(*d.called_for) : nullptr},
                         {"evidence", d.evidence},
                         {"choice", d.choice},
                         {"expected", d.expected}});
    }
    if (!s.output.empty()) write_json(s.output, {{"data", s.scene.data}, {"effects", found}});
}

}  // namespace gs::cli
