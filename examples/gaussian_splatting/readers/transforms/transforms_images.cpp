// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "transforms_images.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "../../core/enumerated.hpp"
#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../point_cloud.hpp"
#include "../validation.hpp"
#include "transforms.hpp"

namespace gs {
namespace {

using enum transforms_number;

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

/// Returns the camera of a frame at the origin. Sets the other intrinsics of the record.
camera camera_of(image_record& record, const transforms& all, std::size_t index) {
    const transforms_lens lens = all.lens_of(index);
    const auto number = [&](transforms_number which) { return all.number(index, which); };
    int photo_width = 0, photo_height = 0;
    read_image_size(record.file, photo_width, photo_height);
    camera taken_with;
    taken_with.width = side(all, index, w, photo_width);
    taken_with.height = side(all, index, h, photo_height);
    if (lens == transforms_lens::panorama)
        return panorama_of_size(taken_with.width, taken_with.height, all.where_is(index));
    const auto said = number(fl_x);
    taken_with.fx = said ? *said : focal_length(all, index, taken_with.width);
    taken_with.fy = number(fl_y).value_or(taken_with.fx);
    taken_with.cx = number(cx).value_or(0.5 * taken_with.width);
    taken_with.cy = number(cy).value_or(0.5 * taken_with.height);
    const auto coefficient = [&](transforms_number which) { return number(which).value_or(0); };
    if (lens == transforms_lens::fisheye)
        taken_with.fisheye = fisheye({coefficient(k1), coefficient(k2), coefficient(k3), coefficient(k4)});
    else
        record.distortion = {coefficient(k1), coefficient(k2), coefficient(p1), coefficient(p2),
                             coefficient(k3)};
    record.camera_model = "OPENCV";
    if (!taken_with.fisheye && coefficient(k4) != 0)
        throw error(all.where_is(index) + ": k4 is " + std::to_string(coefficient(k4)) +
                    ", but only fisheye lenses have a fourth radial coefficient; set k4 to 0, or "
                    "camera_model to OPENCV_FISHEYE");
    if (!has_valid_intrinsics(taken_with, record.distortion))
        throw error(all.where_is(index) + invalid_intrinsics);
    return taken_with;
}

/// Returns a file that the frame names besides the photo, or an empty path if it names none.
std::filesystem::path find_extra(const std::filesystem::path& data, const transforms& all, std::size_t index,
                                 std::string transforms_extras::*path, const char* what) {
    const auto& extras = all.frames[index].extras;
    if (!extras || ((*extras).*path).empty()) return {};
    auto file = data / ((*extras).*path);
    if (!std::filesystem::is_regular_file(file))
        throw error(all.where_is(index) + ": the " + what + " " + sanitize_for_message(file.string()) +
                    " does not exist");
    return file;
}

image_record record_of(const std::filesystem::path& data, const transforms& all, std::size_t index,
                       const load_options& options) {
    image_record record;
    record.file = find_photo(data, all, index);
    record.name = record.file.lexically_relative(data).lexically_normal().generic_string();
    // The path of a frame may be absolute although the path of the scene is relative.
    if (record.name.empty()) record.name = record.file.generic_string();
    record.camera = camera_of(record, all, index);
    record.camera.rotation = all.frames[index].rotation;
    record.camera.translation = all.frames[index].translation;
    if (options.masks) record.mask = find_extra(data, all, index, &transforms_extras::mask, "mask");
    if (options.depths) record.depth = find_extra(data, all, index, &transforms_extras::depth, "depth map");
    record.depth_holds = depth_values::depth;
    return record;
}

}  // namespace

std::vector<image_record> image_records(const std::filesystem::path& data, const transforms& all,
                                        const load_options& options) {
    std::vector<image_record> records;
    records.reserve(all.frames.size());
    for (std::size_t i = 0; i < all.frames.size(); ++i) records.push_back(record_of(data, all, i, options));
    return records;
}

std::vector<colored_point> points_of(const std::filesystem::path& data, const transforms& all) {
    if (all.points.empty()) return {};
    const auto file = data / all.points;
    if (!std::filesystem::is_regular_file(file))
        throw error(all.where + ": the file of ply_file_path, " + sanitize_for_message(file.string()) +
                    ", does not exist");
    return read_point_cloud(file);
}

}  // namespace gs
