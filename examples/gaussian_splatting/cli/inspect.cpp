// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "../core/atomic_file_write.hpp"
#include "../core/write_json.hpp"
#include "../features/feature.hpp"
#include "../pages/inspect_page.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "report.hpp"
#include "run_images.hpp"

namespace gs::cli {

namespace {

namespace fs = std::filesystem;

/// Refuses a page that cannot be written, because the analysis before may take minutes.
void check_page(const settings& s) {
    if (s.html.empty()) return;
    const fs::path file = fs::absolute(s.html).lexically_normal();
    if (!file.has_filename() || fs::is_directory(file))
        throw error("--html " + s.html + " is a folder: name a file in it, such as page.html");
    if (!fs::is_directory(file.parent_path()))
        throw error("cannot write " + s.html + ": the folder " + file.parent_path().string() +
                    " does not exist; make it first");
    if (!s.output.empty() && fs::absolute(s.output).lexically_normal() == file)
        throw error("--html and --output name the same file " + s.html + ": give them different names");
}

const char* word_of(const std::optional<bool>& recommended) {
    return !recommended ? "?" : *recommended ? "yes" : "no";
}

nlohmann::ordered_json to_json(const features::feature& f, const features::finding& found) {
    return {{"name", f.name()},
            {"recommended", found.recommended ? nlohmann::ordered_json(*found.recommended) : nullptr},
            {"evidence", found.evidence},
            {"choice", found.choice},
            {"expected", f.costs_and_gains()}};
}

/// Returns the options of train that overrule a finding.
std::vector<std::string> overruling_options(const features::feature& f, const features::finding& found,
                                            std::vector<std::string> others) {
    const char* const sign = found.recommended.value_or(found.if_unknown) ? "-" : "+";
    if (f.is_selectable()) others.insert(others.begin(), "--effects auto," + (sign + std::string(f.name())));
    return others;
}

pages::inspected_effect for_page(const features::feature& f, const scene_statistics& statistics,
                                 const features::finding& found) {
    features::explanation explained = f.explain(statistics, found);
    const bool is_on = found.recommended.value_or(found.if_unknown);
    return {.name = std::string(f.name()),
            .recommended = found.recommended,
            .evidence = found.evidence,
            .condition = std::move(explained.condition),
            .choice = found.choice,
            .costs_and_gains = std::string(f.costs_and_gains()),
            .overruled_by = overruling_options(f, found, std::move(explained.options)),
            .obstacle = is_on ? "" : f.obstacle(statistics.scene(), found.values),
            .charts = std::move(explained.charts),
            .photos = std::move(explained.photos)};
}

}  // namespace

void inspect(const settings& s) {
    check_page(s);
    const command_context context(s);
    const scene scene = context.load();
    const scene_statistics statistics(scene);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    pages::inspection page{last_part(s.scene.data), scene.train.size(), {}};
    for (const auto& feature : features::all_features()) {
        const features::finding found = feature->analyze(statistics);
        std::printf("%-14s %-4s %s\n%19s -> %s; %s\n", std::string(feature->name()).c_str(),
                    word_of(found.recommended), found.evidence.c_str(), "", found.choice.c_str(),
                    std::string(feature->costs_and_gains()).c_str());
        all.push_back(to_json(*feature, found));
        if (!s.html.empty()) page.effects.push_back(for_page(*feature, statistics, found));
    }
    if (!s.output.empty()) write_json(s.output, {{"data", s.scene.data}, {"effects", all}});
    if (s.html.empty()) return;
    atomic_file_write(s.html, [&](std::ostream& out) { pages::write_inspect_page(out, page); });
    std::printf("page %s\n", s.html.c_str());
}

}  // namespace gs::cli
