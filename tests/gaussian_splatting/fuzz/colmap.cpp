// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "harness.hpp"
#include "readers/colmap/colmap_files.hpp"

namespace gs_fuzz {
namespace {

using reading = void(const std::filesystem::path&, gs::colmap_model&);

bool load_part(std::string_view input, reading* const (&parts)[3]) {
    if (input.empty()) return false;
    reading* const read = parts[static_cast<unsigned char>(input[0]) % 3];
    return load_within_budget(input.substr(1), [&](const std::filesystem::path& file) {
        gs::colmap_model model;
        read(file, model);
    });
}

}  // namespace

bool colmap_binary(std::string_view input) {
    return load_part(input, {gs::read_binary_cameras, gs::read_binary_images, gs::read_binary_points});
}

bool colmap_text(std::string_view input) {
    return load_part(input, {gs::read_text_cameras, gs::read_text_images, gs::read_text_points});
}

}  // namespace gs_fuzz
