// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "harness.hpp"
#include "readers/scene_archive.hpp"

bool gs_fuzz::archive(std::string_view input) {
    constexpr gs::archive_limits limits{.entries = 100, .bytes = 64 << 10};
    // libzip keeps its own record of each entry, and the decompressor has fixed tables.
    constexpr std::size_t libzip = 256 << 10;
    return load_within_budget(
        input, [&](const std::filesystem::path& file) { gs::extracted_archive unpacked(file, limits); },
        [&] { return libzip + 8 * input.size(); });
}
