// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>

#include "../core/error.hpp"
#include "transforms/blender.hpp"
#include "colmap/colmap.hpp"
#include "../scene/scene.hpp"
#include "synthetic/synthetic.hpp"

namespace gs {
namespace {

constexpr std::string_view synthetic_prefix = "synthetic:";

/// Options that say nothing of this kind of scene are refused, not ignored.
void refuse_colmap_options(const load_options& options, const std::string& kind) {
    const load_options defaults;
    if (options.test_every != defaults.test_every)
        throw error("--test-every picks views of a COLMAP scene: a " + kind +
                    " scene has its own test views");
    if (options.images != defaults.images)
        throw error("--images is for COLMAP scenes: a " + kind + " scene names its photos itself");
}

scene load_folder(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data;
    if (!std::filesystem::exists(data)) throw error("there is no folder " + data.string());
    if (!std::filesystem::is_directory(data)) throw error(data.string() + " is not a folder");
    if (std::filesystem::exists(data / "transforms_train.json")) {
        refuse_colmap_options(options, "Blender");
        return load_blender_scene(options, log);
    }
    if (std::filesystem::is_directory(data / "sparse")) return load_colmap_scene(options, log);
    throw error(
        "the folder " + data.string() +
        " is no scene: it has neither transforms_train.json (Blender) nor sparse/0 or sparse (COLMAP)");
}

scene load_folder_or_explain(const load_options& options, const log_function& log) {
    try {
        return load_folder(options, log);
    } catch (const std::filesystem::filesystem_error& problem) {  // no permission, a name too long
        throw error("cannot read " + problem.path1().string() + ": " + problem.code().message());
    }
}

/// A view of each kind that was asked for, or it makes no sense to go on.
void require_views(const scene& loaded, const load_options& options) {
    const std::string split = " (" + std::to_string(loaded.train.size()) + " for training, " +
                              std::to_string(loaded.test.size()) + " held out)";
    if (loaded.train.empty()) throw error(options.data + " has no training views" + split);
    if (options.eval && loaded.test.empty()) throw error(options.data + " has no test views" + split);
}

bool any_has_alpha(const std::vector<view>& views) {
    return std::ranges::any_of(views, [](const view& one) { return one.pixels.has_alpha; });
}

}  // namespace

scene load_scene(const load_options& options, const log_function& log) {
    if (options.resolution < 1)
        throw error("the resolution must be positive, not " + std::to_string(options.resolution));
    const log_function say = log ? log : [](const std::string&) {};
    if (options.data.starts_with(synthetic_prefix)) {
        refuse_colmap_options(options, "synthetic");
        scene made = make_synthetic_scene(options.data.substr(synthetic_prefix.size()), options, say);
        require_views(made, options);
        return made;
    }
    scene loaded = load_folder_or_explain(options, say);
    require_views(loaded, options);
    loaded.has_alpha = any_has_alpha(loaded.train) || any_has_alpha(loaded.test);
    return loaded;
}

}  // namespace gs
