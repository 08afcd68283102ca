// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "../core/error.hpp"
#include "../image/image.hpp"

namespace gs {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> video_endings{".mp4", ".mov", ".mkv", ".avi", ".webm", ".m4v"};

bool ends_like(const fs::path& file, const auto& endings) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::find(endings, ending) != endings.end();
}

bool holds_other_images(const fs::path& folder, const fs::path& excluded) {
    std::error_code ignored;
    return folder.filename() == "masks" || folder.filename() == "depths" ||
           fs::equivalent(folder, excluded, ignored) || fs::exists(folder / "point_cloud", ignored);
}

}  // namespace

bool is_photo_name(const fs::path& file) { return ends_like(file, image_endings()); }

bool is_video_file(const fs::path& file) {
    return ends_like(file, video_endings) && fs::is_regular_file(file);
}

std::vector<std::string> photo_names(const fs::path& folder, const fs::path& excluded) {
    constexpr int most_entries = 1000000;
    std::vector<std::string> names;
    int entries = 0;
    auto next = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied);
    for (; next != fs::recursive_directory_iterator(); ++next) {
        if (++entries > most_entries)
            throw error("the folder " + folder.string() +
                        " has too many files: give the folder of the photos");
        const fs::path& path = next->path();
        const bool is_hidden = path.filename().string().starts_with('.');
        if (next->is_directory()) {
            if (is_hidden || holds_other_images(path, excluded)) next.disable_recursion_pending();
        } else if (!is_hidden && is_photo_name(path) && next->is_regular_file()) {
            names.push_back(path.lexically_relative(folder).generic_string());
        }
    }
    std::ranges::sort(names);
    return names;
}

std::string missing_poses_message(const std::string& data) {
    const bool has_photos = is_video_file(data) || (fs::is_directory(data) && !photo_names(data).empty());
    if (!has_photos) return {};
    return data + (is_video_file(data) ? " is a video" : " contains photos") +
           " without camera poses: train with --poses auto computes them with COLMAP";
}

}  // namespace gs
