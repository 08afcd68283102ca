// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "../core/atomic_file_write.hpp"
#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "../core/parse_json.hpp"
#include "../pages/compare_page.hpp"
#include "commands.hpp"
#include "run_images.hpp"

namespace gs::cli {

namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json json_in(const fs::path& file) {
    nlohmann::ordered_json json = parse_json(file_bytes(file), file.string());
    if (!json.is_object()) throw error(file.string() + " is no JSON object");
    return json;
}

/// Reads what the runs have written. Gives runs of the same name numbers.
std::vector<pages::run_record> records_of(const std::vector<std::string>& folders) {
    std::vector<pages::run_record> runs;
    std::set<std::string> taken;
    for (const fs::path folder : folders) {
        if (!fs::exists(folder / "metrics.json"))
            throw error("cannot compare " + folder.string() +
                        ": it is no folder of a finished run, because it has no metrics.json");
        const std::string last = last_part(folder);
        std::string name = last;
        for (int again = 2; !taken.insert(name).second; ++again) name = last + " " + std::to_string(again);
        runs.push_back({name, json_in(folder / "metrics.json"), json_in(folder / "settings.json")});
    }
    return runs;
}

/// Reads the images of a view of the first run. Returns nothing if the files of a run no longer
/// exist, or another run lacks the view or has it in another size.
std::optional<pages::compared_view> view_of_all(const std::vector<held_out_images>& runs, std::size_t view,
                                                const char* label) {
    const std::string& name = runs.front().names[view];
    if (!fs::exists(runs.front().photo(view))) return {};
    pages::compared_view compared{name, label, read_image(runs.front().photo(view)), {}};
    for (const held_out_images& run : runs) {
        const auto found = std::ranges::find(run.names, name);
        const auto at = static_cast<std::size_t>(found - run.names.begin());
        if (found == run.names.end() || !fs::exists(run.render(at))) return {};
        const image& render = compared.renders.emplace_back(read_image(run.render(at)));
        if (render.width != compared.photo.width || render.height != compared.photo.height) return {};
    }
    return compared;
}

}  // namespace

void compare(const settings& s) {
    if (s.runs.size() < 2) throw error("compare needs the folders of at least two runs");
    const fs::path file = s.output.empty() ? "compare.html" : s.output;
    const std::vector<pages::run_record> runs = records_of(s.runs);
    std::vector<held_out_images> images;
    for (std::size_t i = 0; i < runs.size(); ++i)
        images.push_back(held_out_images_of(s.runs[i], runs[i].metrics));
    std::vector<pages::compared_view> views;
    for (const auto& [view, label] : pages::typical_views(images.front().psnr))
        if (auto compared = view_of_all(images, view, label)) views.push_back(std::move(*compared));
    atomic_file_write(file, [&](std::ostream& out) { pages::write_compare_page(out, runs, views); });
    std::printf("comparison %s\n", file.string().c_str());
}

}  // namespace gs::cli
