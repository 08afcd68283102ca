// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "readers/load_scene.hpp"

/// @file
/// Scenes with a transforms file for tests.

namespace gs_test::transforms_scene {

using nlohmann::json;

inline void write_photo(const std::filesystem::path& file, int width = 20, int height = 16) {
    std::filesystem::create_directories(file.parent_path());
    gs::write_png(file, width, height,
                  std::vector<float>(static_cast<std::size_t>(3 * width * height), 0.5F));
}

inline json matrix_at(double x, double y, double z) {
    return {{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}};
}

/// Photos NAME_0.png and so on, whose cameras look along -z, and the file that describes them.
inline json transforms(const std::filesystem::path& folder, const std::string& name, int count) {
    json result = {{"camera_angle_x", 0.8}, {"frames", json::array()}};
    for (int i = 0; i < count; ++i) {
        const std::string path = "./" + name + "/" + name + "_" + std::to_string(i);
        write_photo(folder / (path + ".png"));
        result["frames"].push_back({{"file_path", path}, {"transform_matrix", matrix_at(i, 0, 3)}});
    }
    return result;
}

inline void write_json(const std::filesystem::path& file, const json& content) {
    write_file(file, content.dump(1));
}

inline gs::load_options options_for(const std::filesystem::path& folder, bool eval = false) {
    gs::load_options options;
    options.data = folder.string();
    options.eval = eval;
    return options;
}

inline void ignore(const std::string&) {}

inline gs::scene load(const std::filesystem::path& folder, bool eval = false) {
    return gs::load_scene(options_for(folder, eval), ignore);
}

inline std::string error_of_loading(const std::filesystem::path& folder, bool eval = false) {
    return error_of([&] { load(folder, eval); });
}

}  // namespace gs_test::transforms_scene
