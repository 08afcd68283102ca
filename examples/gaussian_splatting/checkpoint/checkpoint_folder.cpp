// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "checkpoint_folder.hpp"

#include <charconv>
#include <new>
#include <ranges>
#include <string>
#include <vector>

#include "../core/error.hpp"
#include "checkpoint_file.hpp"

namespace gs {
namespace {

namespace fs = std::filesystem;

const std::string prefix = "iteration_", ending = ".safetensors";

std::optional<int> iteration_in(const std::string& name) {
    if (!name.starts_with(prefix) || !name.ends_with(ending)) return {};
    const char *first = name.data() + prefix.size(), *last = name.data() + name.size() - ending.size();
    int iteration = 0;
    const auto [end, failed] = std::from_chars(first, last, iteration);
    if (failed != std::errc() || end != last) return {};
    return iteration;
}

}  // namespace

fs::path checkpoint_folder::file_of(int iteration) const {
    return folder_ / (prefix + std::to_string(iteration) + ending);
}

std::map<int, fs::path> checkpoint_folder::files() const {
    std::map<int, fs::path> all;
    if (!fs::exists(folder_)) return all;
    for (const auto& entry : fs::directory_iterator(folder_))
        if (const auto iteration = iteration_in(entry.path().filename().string()))
            all[*iteration] = entry.path();
    return all;
}

void checkpoint_folder::write(int iteration, const state_archive& archive, std::size_t keep) const {
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) throw error("cannot make the folder " + folder_.string() + ": " + failed.message());
    for (const auto& entry : fs::directory_iterator(folder_))
        if (entry.path().extension() == ".part") fs::remove(entry.path(), failed);  // of a killed run
    write_checkpoint(file_of(iteration), archive);
    std::size_t newer = 0;
    for (const auto& [of, file] : files() | std::views::reverse)
        if (of <= iteration && newer++ >= keep) fs::remove(file, failed);
}

std::optional<checkpoint_folder::found_checkpoint> checkpoint_folder::newest(const log_function& warn) const {
    const auto all = files();
    std::vector<fs::path> damaged;
    for (const auto& [iteration, file] : all | std::views::reverse) try {
            found_checkpoint found{iteration, file, read_checkpoint(file)};
            // Damaged files must not count when old checkpoints are removed.
            for (const fs::path& bad : damaged) fs::rename(bad, bad.string() + ".damaged");
            return found;
        } catch (const error& problem) {
            warn(problem.what());
            damaged.push_back(file);
        } catch (const std::bad_alloc&) {
            warn("there is not enough memory for the checkpoint " + file.string());
            damaged.push_back(file);
        }
    if (all.empty()) return {};
    throw error("all checkpoints in " + folder_.string() +
                " are damaged: give --overwrite to train from the beginning");
}

}  // namespace gs
