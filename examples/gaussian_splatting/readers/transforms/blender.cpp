// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "blender.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "../../core/sanitize_for_message.hpp"
#include "../../core/error.hpp"
#include "transforms.hpp"
#include "../load_views.hpp"

namespace gs {
namespace {

using enum transforms_number;

/// The photo, whose ending may have been left out.
std::filesystem::path find_photo(const std::filesystem::path& data, const transforms& all,
                                 std::size_t index) {
    const auto plain = data / all.frames[index].path;
    for (const char* ending : {"", ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"}) {
        std::filesystem::path file = plain;
        file += ending;
        if (std::filesystem::is_regular_file(file)) return file;
    }
    throw error(all.where_is(index) + ": the image " + plain.string() +
                " is missing, with and without .png or .jpg");
}

int side(const transforms& all, std::size_t index, transforms_number which, int of_photo) {
    const double value = all.number(index, which).value_or(of_photo);
    if (!(value >= 1 && value <= 65536) || value != std::floor(value))
        throw error(all.where_is(index) + ": " + (which == w ? "w" : "h") + " is " + std::to_string(value) +
                    ", which is no size of a photo");
    return static_cast<int>(value);
}

double focal_length(const transforms& all, std::size_t index, int width) {
    const auto angle = all.number(index, camera_angle_x);
    if (!angle) throw error(all.where_is(index) + ": the field camera_angle_x (or fl_x) is missing");
    if (!(*angle > 0 && *angle < 3.14159))
        throw error(all.where_is(index) + ": camera_angle_x is " + std::to_string(*angle) +
                    ", which must lie between 0 and pi");
    return 0.5 * width / std::tan(0.5 * *angle);
}

void set_intrinsics(recorded_view& recorded, const transforms& all, std::size_t index) {
    camera& taken_with = recorded.camera;
    const auto number = [&](transforms_number which) { return all.number(index, which); };
    int photo_width = 0, photo_height = 0;
    read_image_size(recorded.file, photo_width, photo_height);
    taken_with.width = side(all, index, w, photo_width);
    taken_with.height = side(all, index, h, photo_height);
    const auto said = number(fl_x);
    taken_with.fx = said ? *said : focal_length(all, index, taken_with.width);
    taken_with.fy = number(fl_y).value_or(taken_with.fx);
    taken_with.cx = number(cx).value_or(0.5 * taken_with.width);
    taken_with.cy = number(cy).value_or(0.5 * taken_with.height);
    const auto bend = [&](transforms_number which) { return number(which).value_or(0); };
    if (all.is_fisheye(index))
        taken_with.fisheye = fisheye({bend(k1), bend(k2), bend(k3), bend(k4)});
    else
        recorded.distortion = {bend(k1), bend(k2), bend(p1), bend(p2)};
    recorded.model = all.is_fisheye(index) ? "OPENCV_FISHEYE" : "OPENCV";
    if (!has_sound_intrinsics(taken_with, recorded.distortion))
        throw error(all.where_is(index) + unsound_intrinsics);
}

/// None where the frame has none.
std::filesystem::path find_mask(const std::filesystem::path& data, const transforms& all, std::size_t index) {
    if (all.frames[index].mask.empty()) return {};
    auto file = data / all.frames[index].mask;
    if (!std::filesystem::is_regular_file(file))
        throw error(all.where_is(index) + ": the mask " + clipped(file.string()) + " is no file");
    return file;
}

std::vector<recorded_view> recorded_views(const std::filesystem::path& data,
                                          const std::filesystem::path& file, bool masks) {
    const transforms all = read_transforms(file);
    std::vector<recorded_view> recorded;
    recorded.reserve(all.frames.size());
    for (std::size_t i = 0; i < all.frames.size(); ++i) {
        recorded_view view;
        view.file = find_photo(data, all, i);
        view.name = view.file.lexically_relative(data).lexically_normal().generic_string();
        if (view.name.empty()) view.name = view.file.generic_string();  // absolute, where the scene's is not
        view.camera.rotation = all.frames[i].rotation;
        view.camera.translation = all.frames[i].translation;
        if (masks) view.mask = find_mask(data, all, i);
        set_intrinsics(view, all, i);
        recorded.push_back(std::move(view));
    }
    return recorded;
}

std::vector<recorded_view> recorded_test_views(const std::filesystem::path& data, bool masks) {
    for (const char* name : {"transforms_test.json", "transforms_val.json"})
        if (std::filesystem::exists(data / name)) return recorded_views(data, data / name, masks);
    return {};
}

}  // namespace

scene load_blender_scene(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data;
    std::vector<recorded_view> recorded = recorded_views(data, data / "transforms_train.json", options.masks);
    const std::size_t train_count = recorded.size();
    std::ranges::move(recorded_test_views(data, options.masks), std::back_inserter(recorded));
    std::vector<view> views = load_views(recorded, options, log);
    scene result;
    result.source = "Blender";
    for (std::size_t i = 0; i < views.size(); ++i)
        (options.eval && i >= train_count ? result.test : result.train).push_back(std::move(views[i]));
    return result;
}

}  // namespace gs
