// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "polycam.hpp"

#include <algorithm>

#include "../../core/error.hpp"
#include "../validation.hpp"
#include "depth_points.hpp"
#include "polycam_camera.hpp"

namespace gs {
namespace {

/// Photos with a smaller blur score are left out, as nerfstudio does.
constexpr double least_blur_score = 25;
/// Correction leaves black pixels at the edges of a photo. Nerfstudio crops as many.
constexpr int black_border = 15;

std::filesystem::path keyframes_of(const std::string& data) {
    return std::filesystem::path(data) / "keyframes";
}

/// The folders of cameras and photos that belong together.
struct keyframe_folders {
    std::filesystem::path cameras, photos;
    bool corrected;

    explicit keyframe_folders(const std::filesystem::path& keyframes) {
        const auto has = [&](const char* name) { return std::filesystem::is_directory(keyframes / name); };
        corrected = has("corrected_cameras") && has("corrected_images");
        cameras = keyframes / (corrected ? "corrected_cameras" : "cameras");
        photos = keyframes / (corrected ? "corrected_images" : "images");
        for (const auto& folder : {cameras, photos})
            if (!std::filesystem::is_directory(folder))
                throw error("the folder " + folder.string() + " of the Polycam scene does not exist");
    }
};

std::vector<std::filesystem::path> camera_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::ranges::sort(files);
    if (files.empty()) throw error("the folder " + folder.string() + " has no .json files of cameras");
    return files;
}

std::filesystem::path find_photo(const std::filesystem::path& folder, const std::filesystem::path& camera) {
    for (const char* ending : {".jpg", ".jpeg", ".png"})
        if (auto file = (folder / camera.stem()) += ending; std::filesystem::is_regular_file(file))
            return file;
    throw error(camera.string() + ": the photo " + (folder / camera.stem()).string() + ".jpg is missing");
}

std::vector<image_record> image_records(const std::filesystem::path& keyframes, const load_options& options,
                                        const log_function& log) {
    const keyframe_folders folders(keyframes);
    if (!folders.corrected) log("the Polycam scene has no corrected photos; the original ones are used");
    std::vector<image_record> records;
    std::size_t blurry = 0;
    for (const auto& file : camera_files(folders.cameras)) {
        const polycam_camera found = read_polycam_camera(file);
        if (found.blur_score.value_or(least_blur_score) < least_blur_score) {
            ++blurry;
            continue;
        }
        image_record one;
        one.camera = found.camera;
        one.file = find_photo(folders.photos, file);
        one.name = one.file.filename().string();
        one.camera_model = "PINHOLE";
        if (folders.corrected && options.masks) one.masked_border = black_border;
        const auto depth = keyframes / "depth" / (file.stem().string() + ".png");
        if (std::filesystem::is_regular_file(depth)) one.depth = depth;
        one.depth_holds = depth_values::depth;
        records.push_back(std::move(one));
    }
    if (blurry > 0) log("photos left out because of a blur score below 25: " + std::to_string(blurry));
    if (records.empty()) throw error("all photos of " + keyframes.string() + " have a blur score below 25");
    return records;
}

scene_description describe(const load_options& options, const log_function& log) {
    const std::filesystem::path keyframes = keyframes_of(options.data);
    scene_description result;
    result.images = image_records(keyframes, options, log);
    hold_out_views(result.images, options);
    result.points = points_from_depths(result.images, keyframes / "confidence");
    log(result.points.empty() ? "the Polycam scene has no depth maps, and therefore no points"
                              : std::to_string(result.points.size()) + " points come from the depth maps");
    if (!options.depths)
        for (image_record& one : result.images) one.depth.clear();
    return result;
}

constexpr reader_option used_options[] = {test_every_option};

}  // namespace

constinit const reader polycam_reader{
    "Polycam", "a Polycam folder with keyframes",
    [](const std::string& data) { return std::filesystem::is_directory(keyframes_of(data)); }, describe,
    used_options};

}  // namespace gs
