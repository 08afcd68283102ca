// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "apply_quality_preset.hpp"

#include <algorithm>
#include <array>

namespace gs::cli {

namespace {

struct preset_row {
    quality_preset preset;
    const char *option, *value;
};

constexpr std::array presets{preset_row{quality_preset::fast, "--iterations", "5000"},
                             preset_row{quality_preset::fast, "--sh-lr", "5e-4"},
                             preset_row{quality_preset::best, "--iterations", "30000"}};

}  // namespace

void apply_quality_preset(quality_preset preset, const std::vector<option>& table,
                          const std::function<bool(const std::string&)>& is_explicit) {
    const auto is_excluded = [&](const std::string& name) {
        return std::ranges::any_of(table, [&](const option& o) {
            return is_explicit(o.name()) && std::ranges::find(o.excludes, name) != o.excludes.end();
        });
    };
    for (const preset_row& row : presets) {
        if (row.preset != preset || is_explicit(row.option) || is_excluded(row.option)) continue;
        std::ranges::find(table, std::string(row.option), &option::name)->value.read(row.value);
    }
}

std::string options_of(quality_preset preset) {
    std::string all;
    for (const preset_row& row : presets)
        if (row.preset == preset) all += (all.empty() ? "" : " ") + std::string(row.option) + " " + row.value;
    return all;
}

}  // namespace gs::cli
