// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "colmap.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../../image/mask.hpp"
#include "../validation.hpp"
#include "colmap_files.hpp"

namespace gs {
namespace {

/// Returns the path of `stem.bin` if it exists, otherwise of `stem.txt`, otherwise an empty path.
std::filesystem::path find_part(const std::filesystem::path& folder, const std::string& stem) {
    for (const char* ending : {".bin", ".txt"})
        if (const auto file = folder / (stem + ending); std::filesystem::exists(file)) return file;
    return {};
}

std::filesystem::path require_part(const std::filesystem::path& folder, const std::string& stem) {
    auto file = find_part(folder, stem);
    if (file.empty())
        throw error("the COLMAP model " + folder.string() + " has no " + stem + ": neither " + stem +
                    ".bin nor " + stem + ".txt exists");
    return file;
}

bool is_binary(const std::filesystem::path& file) { return file.extension() == ".bin"; }

std::filesystem::path model_folder(const std::filesystem::path& data) {
    const auto sparse = data / "sparse";
    return std::filesystem::is_directory(sparse / "0") ? sparse / "0" : sparse;
}

void sort_by_id(std::vector<colmap_camera>& cameras, const std::filesystem::path& file) {
    std::ranges::sort(cameras, {}, &colmap_camera::id);
    const auto twice = std::ranges::adjacent_find(cameras, {}, &colmap_camera::id);
    if (twice != cameras.end())
        throw error(file.string() + " lists the camera " + std::to_string(twice->id) + " twice");
}

const colmap_camera& camera_of(const colmap_image& taken, const colmap_model& model) {
    const auto found = std::ranges::lower_bound(model.cameras, taken.camera_id, {}, &colmap_camera::id);
    if (found == model.cameras.end() || found->id != taken.camera_id)
        throw error(model.images_file.string() + ": the image " + sanitize_for_message(model.name(taken)) +
                    " refers to camera " + std::to_string(taken.camera_id) + ", which does not exist");
    return *found;
}

std::optional<std::uint32_t> frame_of(const colmap_image& taken, const colmap_model& model) {
    const auto found =
        std::ranges::lower_bound(model.frames, std::uint64_t{taken.id}, {}, &colmap_frame_image::image_id);
    if (found == model.frames.end() || found->image_id != taken.id) return {};
    return found->frame_id;
}

std::vector<image_record> image_records(const colmap_model& model, const std::filesystem::path& photos,
                                        const std::filesystem::path& masks,
                                        const std::filesystem::path& depths) {
    std::vector<image_record> records;
    records.reserve(model.images.size());
    for (const colmap_image& taken : model.images) {
        const colmap_camera& by = camera_of(taken, model);
        const std::string_view name = model.name(taken);
        if (name.size() > longest_path)
            throw error(model.images_file.string() + ": the name of the image " + sanitize_for_message(name) +
                        " is too long");
        image_record one;
        one.name = name;
        one.file = photos / name;
        one.camera = by.camera();
        one.distortion = by.distortion();
        one.camera_model = by.model().name;
        one.rig_frame = frame_of(taken, model);
        if (!masks.empty()) one.mask = beside_photo(masks, one.name);
        if (!depths.empty()) one.depth = beside_photo(depths, one.name);
        one.camera.rotation = glm::mat3_cast(taken.rotation);
        one.camera.translation = taken.translation;
        records.push_back(std::move(one));
    }
    std::ranges::sort(records, {}, &image_record::name);
    const auto twice = std::ranges::adjacent_find(records, {}, &image_record::name);
    if (twice != records.end())
        throw error(model.images_file.string() + " lists the image " + sanitize_for_message(twice->name) +
                    " twice");
    return records;
}

scene_description describe(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data, photos = data / options.images;
    colmap_model model = read_colmap_model(model_folder(data));
    scene_description result;
    result.images = image_records(model, photos, options.masks ? data / "masks" : std::filesystem::path(),
                                  options.depths ? data / "depths" : std::filesystem::path());
    if (!std::filesystem::is_directory(photos))
        throw error("the folder of photos " + photos.string() +
                    " does not exist: name another with --images");
    hold_out_views(result.images, options);
    result.points = std::move(model.points);
    if (result.points.empty()) log("the COLMAP model has no points");
    return result;
}

constexpr reader_option used_options[] = {images_option, test_every_option};

}  // namespace

colmap_model read_colmap_model(const std::filesystem::path& folder) {
    const auto cameras = require_part(folder, "cameras");
    const auto images = require_part(folder, "images");
    const auto points = find_part(folder, "points3D");
    colmap_model model;
    model.images_file = images;
    (is_binary(cameras) ? read_binary_cameras : read_text_cameras)(cameras, model);
    if (model.cameras.empty()) throw error(cameras.string() + " lists no cameras");
    sort_by_id(model.cameras, cameras);
    (is_binary(images) ? read_binary_images : read_text_images)(images, model);
    if (model.images.empty()) throw error(images.string() + " lists no images");
    if (!points.empty()) (is_binary(points) ? read_binary_points : read_text_points)(points, model);
    if (const auto frames = find_part(folder, "frames"); !frames.empty()) {
        (is_binary(frames) ? read_binary_frames : read_text_frames)(frames, model);
        std::ranges::sort(model.frames, {}, &colmap_frame_image::image_id);
    }
    return model;
}

constinit const reader colmap_reader{
    "COLMAP", "a COLMAP folder with sparse/0 or sparse",
    [](const std::string& data) {
        return std::filesystem::is_directory(std::filesystem::path(data) / "sparse");
    },
    describe, used_options};

}  // namespace gs
