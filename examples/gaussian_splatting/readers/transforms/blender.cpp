// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "blender.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "../../core/enumerated.hpp"
#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../validation.hpp"
#include "transforms.hpp"

namespace gs {
namespace {

using enum transforms_number;

constexpr const char* training_file = "transforms_train.json";

/// Returns the file of the photo. The path in the frame may omit the ending.
std::filesystem::path find_photo(const std::filesystem::path& data, const transforms& all,
                                 std::size_t index) {
    const auto plain = data / all.frames[index].path;
    if (std::filesystem::is_regular_file(plain)) return plain;
    const std::vector<std::string_view> endings = image_endings();
    for (const std::string_view lower : endings) {
        std::string upper(lower);
        std::ranges::transform(upper, upper.begin(),
                               [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        for (const auto& ending : {std::string(lower), upper}) {
            std::filesystem::path file = plain;
            file += ending;
            if (std::filesystem::is_regular_file(file)) return file;
        }
    }
    throw error(all.where_is(index) + ": the image " + plain.string() + " is missing, also with the ending " +
                enumerated(endings, " or "));
}

int side(const transforms& all, std::size_t index, transforms_number which, int of_photo) {
    const double value = all.number(index, which).value_or(of_photo);
    if (!(value >= 1 && value <= 65536) || value != std::floor(value))
        throw error(all.where_is(index) + ": " + (which == w ? "w" : "h") + " is " + std::to_string(value) +
                    ", but must be a whole number from 1 to 65536");
    return static_cast<int>(value);
}

double focal_length(const transforms& all, std::size_t index, int width) {
    const auto angle = all.number(index, camera_angle_x);
    if (!angle) throw error(all.where_is(index) + ": the field camera_angle_x (or fl_x) is missing");
    if (!(*angle > 0 && *angle < 3.14159))
        throw error(all.where_is(index) + ": camera_angle_x is " + std::to_string(*angle) +
                    ", but must lie between 0 and pi");
    return 0.5 * width / std::tan(0.5 * *angle);
}

void set_intrinsics(image_record& record, const transforms& all, std::size_t index) {
    camera& taken_with = record.camera;
    const auto number = [&](transforms_number which) { return all.number(index, which); };
    int photo_width = 0, photo_height = 0;
    read_image_size(record.file, photo_width, photo_height);
    taken_with.width = side(all, index, w, photo_width);
    taken_with.height = side(all, index, h, photo_height);
    const auto said = number(fl_x);
    taken_with.fx = said ? *said : focal_length(all, index, taken_with.width);
    taken_with.fy = number(fl_y).value_or(taken_with.fx);
    taken_with.cx = number(cx).value_or(0.5 * taken_with.width);
    taken_with.cy = number(cy).value_or(0.5 * taken_with.height);
    const auto coefficient = [&](transforms_number which) { return number(which).value_or(0); };
    if (all.is_fisheye(index))
        taken_with.fisheye = fisheye({coefficient(k1), coefficient(k2), coefficient(k3), coefficient(k4)});
    else
        record.distortion = {coefficient(k1), coefficient(k2), coefficient(p1), coefficient(p2)};
    record.camera_model = all.is_fisheye(index) ? "OPENCV_FISHEYE" : "OPENCV";
    if (!has_valid_intrinsics(taken_with, record.distortion))
        throw error(all.where_is(index) + invalid_intrinsics);
}

/// Returns the file of the mask, or an empty path if the frame names none.
std::filesystem::path find_mask(const std::filesystem::path& data, const transforms& all, std::size_t index) {
    if (all.frames[index].mask.empty()) return {};
    auto file = data / all.frames[index].mask;
    if (!std::filesystem::is_regular_file(file))
        throw error(all.where_is(index) + ": the mask " + sanitize_for_message(file.string()) +
                    " does not exist");
    return file;
}

std::vector<image_record> image_records(const std::filesystem::path& data, const std::filesystem::path& file,
                                        const load_options& options, bool held_out) {
    const transforms all = read_transforms(file);
    std::vector<image_record> records;
    records.reserve(all.frames.size());
    for (std::size_t i = 0; i < all.frames.size(); ++i) {
        image_record record;
        record.file = find_photo(data, all, i);
        record.name = record.file.lexically_relative(data).lexically_normal().generic_string();
        // The path of a frame may be absolute although the path of the scene is relative.
        if (record.name.empty()) record.name = record.file.generic_string();
        record.held_out = held_out;
        record.camera.rotation = all.frames[i].rotation;
        record.camera.translation = all.frames[i].translation;
        if (options.masks) record.mask = find_mask(data, all, i);
        set_intrinsics(record, all, i);
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<image_record> test_records(const std::filesystem::path& data, const load_options& options) {
    for (const char* name : {"transforms_test.json", "transforms_val.json"})
        if (std::filesystem::exists(data / name)) return image_records(data, data / name, options, true);
    return {};
}

scene_description describe(const load_options& options, const log_function&) {
    const std::filesystem::path data = options.data;
    scene_description result;
    result.object_centered = true;
    result.images = image_records(data, data / training_file, options, false);
    std::ranges::move(test_records(data, options), std::back_inserter(result.images));
    return result;
}

}  // namespace

constinit const reader blender_reader{
    "Blender", "a Blender folder with transforms_train.json",
    [](const std::string& data) {
        return std::filesystem::exists(std::filesystem::path(data) / training_file);
    },
    describe};

}  // namespace gs
