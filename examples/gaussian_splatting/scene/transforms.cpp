// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "../clipped.hpp"
#include "../error.hpp"
#include "file_bytes.hpp"
#include "json_reader.hpp"
#include "views.hpp"

namespace gs {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// NaN where there is something else.
double read_number(json_reader& json) {
    if (json.at_number()) return json.number();
    json.skip();
    return not_a_number;
}

/// The last one said is the one that counts.
class said_numbers {
  public:
    /// Reads the value if the field is one of them.
    bool read(const std::string& field, json_reader& json) {
        const auto found = std::ranges::find(transforms_number_names, field);
        if (found == transforms_number_names.end()) return false;
        const double value = read_number(json);
        values_[static_cast<std::size_t>(found - transforms_number_names.begin())] =
            std::isfinite(value) ? value : not_a_number;
        return true;
    }

    std::vector<said_number> list() const {
        std::vector<said_number> said;
        said.reserve(static_cast<std::size_t>(
            std::ranges::count_if(values_, [](const auto& value) { return value.has_value(); })));
        for (std::size_t i = 0; i < values_.size(); ++i)
            if (values_[i]) said.push_back({static_cast<transforms_number>(i), *values_[i]});
        return said;
    }

  private:
    std::array<std::optional<double>, transforms_number_names.size()> values_;
};

/// Calls `element(i)` for each of an array's; whether the value is an array, and of `size`.
template <class Element>
bool read_array_of(std::size_t size, json_reader& json, const Element& element) {
    if (!json.at_array()) {
        json.skip();
        return false;
    }
    std::size_t count = 0;
    json.array([&](std::size_t i) {
        ++count;
        i < size ? element(i) : json.skip();
    });
    return count == size;
}

/// Nothing unless it is 4x4 finite numbers.
std::optional<glm::dmat4> read_matrix(json_reader& json) {
    glm::dmat4 matrix(0);
    bool sound = true;
    const bool square = read_array_of(4, json, [&](std::size_t row) {
        sound &= read_array_of(4, json, [&](std::size_t column) {
            double& cell = matrix[static_cast<int>(column)][static_cast<int>(row)];
            cell = read_number(json);
            sound &= std::isfinite(cell);
        });
    });
    if (!square || !sound) return std::nullopt;
    return matrix;
}

bool is_near_rotation(const glm::dmat3& matrix, double tolerance) {
    const glm::dmat3 product = glm::transpose(matrix) * matrix;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)  // written so that NaN fails too
            if (!(std::abs(product[column][row] - (column == row ? 1.0 : 0.0)) <= tolerance)) return false;
    return true;
}

/// The rotation nearest to a matrix that almost is one (Newton's iteration for the polar decomposition).
glm::dmat3 nearest_rotation(glm::dmat3 matrix) {
    for (int i = 0; i < 4; ++i) matrix = 0.5 * (matrix + glm::transpose(glm::inverse(matrix)));
    return matrix;
}

/// Sets the pose from the file's camera-to-world matrix, whose camera looks along -z with y up.
void set_pose(transforms_frame& frame, const glm::dmat4& matrix, const std::string& where) {
    constexpr double tolerance = 1e-3;
    const glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (std::abs(volume) < 1e-9) throw error(where + ": transform_matrix is singular");
    const glm::dvec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1);
    if (!(volume > 0 && is_near_rotation(axes, tolerance) && glm::dot(last_row, last_row) <= tolerance))
        throw error(where + ": transform_matrix is not a rotation and a translation");
    const glm::dmat3 to_world = nearest_rotation(axes);
    const glm::dmat3 ours(to_world[0], -to_world[1], -to_world[2]);
    frame.rotation = glm::transpose(ours);
    frame.translation = -frame.rotation * glm::dvec3(matrix[3]);
    if (!is_sound_place(matrix[3]))
        throw error(where + ": the translation of transform_matrix" + unsound_place);
}

void read_frame(json_reader& json, transforms& into) {
    const std::size_t index = into.frames.size();
    transforms_frame& frame = into.frames.emplace_back();
    const auto refuse_value = [&](const char* why) {
        json.skip();  // what is no JSON at all says so first
        throw error(into.where_is(index) + why);
    };
    if (!json.at_object()) refuse_value(" is not a JSON object");
    said_numbers numbers;
    bool has_path = false, has_matrix = false;
    std::optional<glm::dmat4> matrix;
    json.object([&](const std::string& field) {
        if (field == "file_path") {
            if (!json.at_string()) refuse_value(": file_path is not a string");
            frame.path = json.string();
            has_path = true;
        } else if (field == "transform_matrix") {
            matrix = read_matrix(json);
            has_matrix = true;
        } else if (!numbers.read(field, json)) {
            json.skip();
        }
    });
    if (!has_path) throw error(into.where_is(index) + ": the field file_path is missing");
    const std::string where = into.where_is(index);
    if (frame.path.size() > longest_path)
        throw error("cannot read the photo of " + where + ": its path is too long");
    if (!has_matrix) throw error(where + ": the field transform_matrix is missing");
    if (!matrix) throw error(where + ": transform_matrix is not 4x4 finite numbers");
    set_pose(frame, *matrix, where);
    frame.numbers = numbers.list();
}

std::optional<double> find_in(const std::vector<said_number>& numbers, transforms_number which) {
    const auto found = std::ranges::find(numbers, which, &said_number::which);
    if (found == numbers.end()) return std::nullopt;
    return found->value;
}

}  // namespace

std::string transforms::where_is(std::size_t index) const {
    const std::string& path = frames[index].path;
    return where + " frame " + std::to_string(index) + (path.empty() ? "" : " (" + clipped(path) + ")");
}

std::optional<double> transforms::number(std::size_t index, transforms_number which) const {
    auto value = find_in(frames[index].numbers, which);
    if (!value) value = find_in(numbers, which);
    if (value && std::isnan(*value))
        throw error(where_is(index) + ": " +
                    std::string(transforms_number_names[static_cast<std::size_t>(which)]) +
                    " is not a number");
    return value;
}

transforms read_transforms(const std::filesystem::path& file) {
    transforms result;
    result.where = file.string();
    const std::string text = file_bytes(file);
    json_reader json(result.where, text);
    if (!json.at_object()) {
        json.skip();
        json.end();
        throw error(result.where + " is not a JSON object");
    }
    said_numbers numbers;
    bool has_frames = false;
    json.object([&](const std::string& field) {
        if (field == "frames") {
            if (has_frames) throw error(result.where + " has the field frames twice");
            if (!json.at_array()) {
                json.skip();
                throw error(result.where + ": frames is not an array");
            }
            json.array([&](std::size_t) { read_frame(json, result); });
            has_frames = true;
        } else if (!numbers.read(field, json)) {
            json.skip();
        }
    });
    json.end();
    if (!has_frames) throw error(result.where + ": the field frames is missing");
    result.numbers = numbers.list();
    return result;
}

}  // namespace gs
