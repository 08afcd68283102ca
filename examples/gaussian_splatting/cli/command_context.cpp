// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "command_context.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <ranges>
#include <thread>
#include <vector>

#include "../core/error.hpp"
#include "highlighted.hpp"

namespace gs::cli {

namespace fs = std::filesystem;

void command_context::say(const std::string& line) const {
    if (settings_.log_level >= log_level::info) std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

void command_context::warn(const std::string& line) const {
    if (settings_.log_level >= log_level::warning)
        std::printf("%s %s\n", highlighted("warning:", message_color::yellow, stdout).c_str(), line.c_str());
    std::fflush(stdout);
}

scene command_context::load(const load_options& source) const {
    const auto log = [this](const std::string& line) { say(line); };
    scene loaded = load_scene(source, log);
    normalize(loaded, log);
    return loaded;
}

bool command_context::can_use_cuda() const {
    std::string reason;
    return can_use_cuda(reason);
}

bool command_context::can_use_cuda(std::string& reason) const {
    const bool usable = settings_.device != device_kind::cpu && train::cuda_is_available(reason);
    if (settings_.device == device_kind::cuda && !usable)
        throw error("--device cuda: no GPU can be used: " + reason);
    return usable;
}

std::unique_ptr<train::engine> command_context::make_engine() const {
    std::string reason;
    const bool usable = can_use_cuda(reason);
    if (settings_.device == device_kind::automatic && !usable) say("using the CPU: " + reason);
    return usable ? train::make_cuda_engine() : train::make_cpu_engine();
}

std::unique_ptr<evaluate::lpips_network> command_context::load_lpips() const {
    if (settings_.lpips.empty()) return nullptr;
    auto network = std::make_unique<evaluate::lpips_network>(settings_.lpips);
    say("computes LPIPS on the CPU, with inputs from " + std::to_string(network->black()) + " to 1");
    return network;
}

train::background_choice command_context::background(bool alpha) const {
    const background_kind kind = settings_.background;
    const bool white = kind == background_kind::white || (kind != background_kind::black && alpha);
    const float level = white ? 1.0f : 0.0f;
    return {{level, level, level}, kind == background_kind::random};
}

void command_context::require_no_background_before(const gaussians& model) const {
    if (!model.sky.empty() && settings_.background != background_kind::automatic)
        throw error("--background " + name_of(settings_.background) + ": " + settings_.ply +
                    " has a sky, which takes its place: leave out --background");
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
        if (entry.is_directory(ignored) && !entry.is_symlink(ignored)) folders.push_back(entry.path());
    // Removes the innermost folders first. Folders that are not empty stay, because their removal
    // fails.
    for (const fs::path& folder : folders | std::views::reverse) fs::remove(folder, ignored);
}

bool appears(const fs::path& folder) {
    constexpr double seconds = 60;
    const stopwatch waiting;
    while (!fs::is_directory(folder)) {
        if (waiting.seconds() > seconds) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return true;
}

}  // namespace gs::cli
