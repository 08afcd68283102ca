// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "readable_photos.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "../core/error.hpp"
#include "../core/parallel.hpp"
#include "../image/image.hpp"

namespace gs::poses {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> colmap_endings{".jpg", ".jpeg", ".png"};

bool is_readable(const std::string& name) {
    std::string ending = fs::path(name).extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::find(colmap_endings, ending) != colmap_endings.end();
}

std::string readable_name(const std::string& name) { return is_readable(name) ? name : name + ".png"; }

void convert(const fs::path& from, const fs::path& to) {
    image photo = read_image(from);
    const orientation turn = read_image_header(from).turn;
    if (turn != orientation()) photo = turned_upright(photo, turn);
    constexpr float white[3] = {1, 1, 1};
    write_png(to, photo.width, photo.height, over_background(photo, white));
}

}  // namespace

bool is_readable_by_colmap(const photo_set& photos) { return std::ranges::all_of(photos.names, is_readable); }

photo_set make_readable(const photo_set& photos, const fs::path& folder, const listener& user) {
    const stopwatch watch;
    photo_set readable{folder, {}, photos.are_frames};
    for (const std::string& name : photos.names) {
        readable.names.push_back(readable_name(name));
        fs::create_directories((folder / name).parent_path());
    }
    for_each_in_parallel(photos.names.size(), [&](std::size_t i) {
        const fs::path from = photos.folder / photos.names[i], to = folder / readable.names[i];
        if (is_readable(photos.names[i])) {
            fs::copy_file(from, to);
        } else {
            convert(from, to);
        }
    });
    std::ranges::sort(readable.names);
    const auto converted =
        std::ranges::count_if(photos.names, [](const std::string& name) { return !is_readable(name); });
    user.say("converted " + std::to_string(converted) +
             " photos that COLMAP cannot read to PNG: " + watch.text());
    return readable;
}

}  // namespace gs::poses
