// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "blender.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "../error.hpp"
#include "file_bytes.hpp"
#include "views.hpp"

namespace gs {
namespace {

using nlohmann::json;

/// Python's json writes NaN and Infinity, which JSON does not have. They become empty objects of the same
/// length: nowhere a number, so that the frame that holds one can be named, and no byte moves.
std::string with_nan_as_object(std::string text) {
    constexpr std::string_view no_numbers[] = {"NaN", "-Infinity", "Infinity"};
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (quoted && text[i] == '\\') {
            ++i;
        } else if (text[i] == '"') {
            quoted = !quoted;
        } else if (!quoted) {
            for (const std::string_view word : no_numbers)
                if (text.compare(i, word.size(), word) == 0)
                    text.replace(i, word.size(), "{}" + std::string(word.size() - 2, ' '));
        }
    }
    return text;
}

json parse(const std::filesystem::path& file) {
    const std::string text = with_nan_as_object(file_bytes(file));
    try {
        return json::parse(text);
    } catch (const json::parse_error& problem) {
        const auto before = static_cast<std::ptrdiff_t>(std::min(problem.byte, text.size()));
        const auto line = 1 + std::count(text.begin(), text.begin() + before, '\n');
        throw error(file.string() + " is not valid JSON: line " + std::to_string(line) + ", byte " +
                    std::to_string(problem.byte));
    } catch (const json::out_of_range&) {
        throw error(file.string() + " holds a number that is too large");
    }
}

/// One frame of a transforms file. What it does not say itself is said for all frames at the top.
class frame {
  public:
    frame(const std::filesystem::path& file, const json& top, const json& own, std::size_t index)
        : top_(top), own_(own), where_(file.string() + " frame " + std::to_string(index)) {
        if (!own.is_object()) throw error(where_ + " is not a JSON object");
        const json& path = field("file_path");
        if (!path.is_string()) throw error(where_ + ": file_path is not a string");
        path_ = path.get<std::string>();
        where_ += " (" + path_ + ")";
    }

    const std::string& path() const { return path_; }
    const std::string& where() const { return where_; }

    const json* find(const char* name) const {
        for (const json* object : {&own_, &top_})
            if (const auto found = object->find(name); found != object->end()) return &*found;
        return nullptr;
    }

    const json& field(const char* name) const {
        const json* found = find(name);
        if (!found) throw error(where_ + ": the field " + name + " is missing");
        return *found;
    }

    std::optional<double> number(const char* name) const {
        const json* found = find(name);
        if (!found) return std::nullopt;
        if (!found->is_number()) throw error(where_ + ": " + name + " is not a number");
        return found->get<double>();
    }

    std::optional<int> side(const char* name) const {
        const auto value = number(name);
        if (!value) return std::nullopt;
        if (!(*value >= 1 && *value <= 65536) || *value != std::floor(*value))
            throw error(where_ + ": " + name + " is " + std::to_string(*value) +
                        ", which is no size of a photo");
        return static_cast<int>(*value);
    }

  private:
    const json& top_;
    const json& own_;
    std::string path_;
    std::string where_;
};

/// The photo, whose ending may have been left out.
std::filesystem::path find_photo(const std::filesystem::path& data, const frame& one) {
    const auto plain = data / one.path();
    for (const char* ending : {"", ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"}) {
        std::filesystem::path file = plain;
        file += ending;
        if (std::filesystem::is_regular_file(file)) return file;
    }
    throw error(one.where() + ": the image " + plain.string() + " is missing, with and without .png or .jpg");
}

glm::dmat4 read_matrix(const frame& one) {
    const json& rows = one.field("transform_matrix");
    const auto malformed = [&] {
        return error(one.where() + ": transform_matrix is not 4x4 finite numbers");
    };
    if (!rows.is_array() || rows.size() != 4) throw malformed();
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        const json& cells = rows[static_cast<std::size_t>(row)];
        if (!cells.is_array() || cells.size() != 4) throw malformed();
        for (int column = 0; column < 4; ++column) {
            const json& cell = cells[static_cast<std::size_t>(column)];
            if (!cell.is_number()) throw malformed();
            matrix[column][row] = cell.get<double>();
        }
    }
    return matrix;
}

double distance_from_rotation(const glm::dmat3& matrix) {
    const glm::dmat3 product = glm::transpose(matrix) * matrix;
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(product[column][row] - (column == row ? 1.0 : 0.0)));
    return largest;
}

/// The rotation nearest to a matrix that almost is one (Newton's iteration for the polar decomposition).
glm::dmat3 nearest_rotation(glm::dmat3 matrix) {
    for (int i = 0; i < 4; ++i) matrix = 0.5 * (matrix + glm::transpose(glm::inverse(matrix)));
    return matrix;
}

/// Sets the pose from the file's camera-to-world matrix, whose camera looks along -z with y up.
void set_pose(camera& pinhole, const frame& one) {
    constexpr double tolerance = 1e-3;
    const glm::dmat4 matrix = read_matrix(one);
    const glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (std::abs(volume) < 1e-9) throw error(one.where() + ": transform_matrix is singular");
    const glm::dvec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1);
    if (volume < 0 || distance_from_rotation(axes) > tolerance || glm::dot(last_row, last_row) > tolerance)
        throw error(one.where() + ": transform_matrix is not a rotation and a translation");
    const glm::dmat3 to_world = nearest_rotation(axes);
    const glm::dmat3 ours(to_world[0], -to_world[1], -to_world[2]);
    pinhole.rotation = glm::transpose(ours);
    pinhole.translation = -pinhole.rotation * glm::dvec3(matrix[3]);
}

double focal_length(const frame& one, int width) {
    const double angle = *one.number("camera_angle_x");
    if (!(angle > 0 && angle < 3.14159))
        throw error(one.where() + ": camera_angle_x is " + std::to_string(angle) +
                    ", which must lie between 0 and pi");
    return 0.5 * width / std::tan(0.5 * angle);
}

void set_intrinsics(recorded_view& recorded, const frame& one) {
    camera& pinhole = recorded.camera;
    int photo_width = 0, photo_height = 0;
    read_image_size(recorded.file, photo_width, photo_height);
    pinhole.width = one.side("w").value_or(photo_width);
    pinhole.height = one.side("h").value_or(photo_height);
    const auto fl_x = one.number("fl_x");
    if (!fl_x && !one.find("camera_angle_x"))
        throw error(one.where() + ": the field camera_angle_x (or fl_x) is missing");
    pinhole.fx = fl_x ? *fl_x : focal_length(one, pinhole.width);
    pinhole.fy = one.number("fl_y").value_or(pinhole.fx);
    pinhole.cx = one.number("cx").value_or(0.5 * pinhole.width);
    pinhole.cy = one.number("cy").value_or(0.5 * pinhole.height);
    recorded.distortion = {one.number("k1").value_or(0), one.number("k2").value_or(0),
                           one.number("p1").value_or(0), one.number("p2").value_or(0)};
    recorded.model = "OPENCV";
    if (!has_sound_intrinsics(pinhole, recorded.distortion))
        throw error(one.where() +
                    " has a focal length that is not positive, or a parameter that is not finite");
}

std::vector<recorded_view> read_transforms(const std::filesystem::path& data,
                                           const std::filesystem::path& file) {
    const json top = parse(file);
    if (!top.is_object()) throw error(file.string() + " is not a JSON object");
    const auto frames = top.find("frames");
    if (frames == top.end()) throw error(file.string() + ": the field frames is missing");
    if (!frames->is_array()) throw error(file.string() + ": frames is not an array");
    std::vector<recorded_view> recorded;
    recorded.reserve(frames->size());
    for (std::size_t i = 0; i < frames->size(); ++i) {
        const frame one(file, top, (*frames)[i], i);
        recorded_view view;
        view.file = find_photo(data, one);
        view.name = view.file.lexically_relative(data).lexically_normal().generic_string();
        if (view.name.empty()) view.name = view.file.generic_string();  // absolute, where the scene's is not
        set_pose(view.camera, one);
        set_intrinsics(view, one);
        recorded.push_back(std::move(view));
    }
    return recorded;
}

std::vector<recorded_view> read_test_transforms(const std::filesystem::path& data) {
    for (const char* name : {"transforms_test.json", "transforms_val.json"})
        if (std::filesystem::exists(data / name)) return read_transforms(data, data / name);
    return {};
}

}  // namespace

scene load_blender_scene(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data;
    std::vector<recorded_view> recorded = read_transforms(data, data / "transforms_train.json");
    const std::size_t train_count = recorded.size();
    std::ranges::move(read_test_transforms(data), std::back_inserter(recorded));
    std::vector<view> views = load_views(recorded, options, log);
    scene result;
    result.source = "Blender";
    for (std::size_t i = 0; i < views.size(); ++i)
        (options.eval && i >= train_count ? result.test : result.train).push_back(std::move(views[i]));
    return result;
}

}  // namespace gs
