// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "command_context.hpp"

#include <cstdio>
#include <fstream>
#include <ranges>
#include <vector>

#include "../core/error.hpp"
#include "../core/atomic_file_write.hpp"

namespace gs::cli {

namespace fs = std::filesystem;

void session::say(const std::string& line) const {
    if (!settings_.quiet) std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

scene session::load() const {
    const auto log = [this](const std::string& line) { say(line); };
    scene loaded = load_scene(settings_.scene, log);
    recentre(loaded, log);
    return loaded;
}

std::unique_ptr<train::engine> session::make_engine() const {
    std::string reason;
    const bool there = settings_.device != "cpu" && train::cuda_is_available(reason);
    if (settings_.device == "cuda" && !there) throw error("--device cuda: no GPU can be used: " + reason);
    return there ? train::make_cuda_engine() : train::make_cpu_engine();
}

train::background_choice session::background(bool alpha) const {
    const bool white = settings_.background == "white" || (settings_.background != "black" && alpha);
    const float level = white ? 1.0f : 0.0f;
    return {{level, level, level}, settings_.background == "random"};
}

void session::require_no_background_before(const gaussians& model) const {
    if (!model.sky.empty() && settings_.background != "auto")
        throw error("--background " + settings_.background + ": " + settings_.ply +
                    " has a sky, which takes its place");
}

output_folder::output_folder(const fs::path& path) : path_(path) {
    if (fs::exists(path) && !fs::is_directory(path))
        throw error("cannot write to " + path.string() + ": it is not a folder");
    fs::path top = fs::absolute(path).lexically_normal();
    if (!top.has_filename()) top = top.parent_path();
    for (; !fs::exists(top); top = top.parent_path()) made_ = top;
    std::error_code failed;
    fs::create_directories(path, failed);
    if (failed) throw error("cannot make the folder " + path.string() + ": " + failed.message());
    const fs::path probe = path / ".writable";
    const bool writable = std::ofstream(probe).put('\n').flush().good();
    fs::remove(probe, failed);
    if (!writable) throw error("cannot write to the folder " + path.string());
}

output_folder::~output_folder() {
    if (made_.empty()) return;
    std::error_code ignored;
    std::vector<fs::path> folders{made_};
    for (const auto& entry : fs::recursive_directory_iterator(made_, ignored))
        if (entry.is_directory(ignored)) folders.push_back(entry.path());
    // From the innermost out; one that holds something cannot be removed.
    for (const fs::path& folder : folders | std::views::reverse) fs::remove(folder, ignored);
}

nlohmann::ordered_json to_json(const evaluate::test_report& report) {
    nlohmann::ordered_json json;
    json["psnr"] = nullptr;
    json["ssim"] = nullptr;
    json["views"] = nlohmann::ordered_json::array();
    if (report.views.empty()) return json;
    json["psnr"] = report.psnr();
    json["ssim"] = report.ssim();
    if (const auto fitted = report.fitted_psnr()) json["fitted_psnr"] = *fitted;
    for (const auto& v : report.views) {
        json["views"].push_back({{"name", v.name}, {"psnr", v.quality.psnr()}, {"ssim", v.quality.ssim}});
        if (v.fitted_psnr) json["views"].back()["fitted_psnr"] = *v.fitted_psnr;
    }
    return json;
}

std::string fitted_part(const evaluate::test_report& report) {
    const auto fitted = report.fitted_psnr();
    if (!fitted) return "";
    char text[64];
    std::snprintf(text, sizeof text, ", %.2f dB after fitting exposures", *fitted);
    return text;
}

void write_json(const fs::path& file, const nlohmann::ordered_json& json) {
    write_aside(file, [&](std::ostream& out) {
        out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
    });
}

}  // namespace gs::cli
