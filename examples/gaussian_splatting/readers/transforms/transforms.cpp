// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../camera_models.hpp"
#include "../json_events.hpp"
#include "transforms_pose.hpp"

namespace gs {
namespace {

/// The numbers of a frame or of the whole file. A later value replaces an earlier one.
class number_fields {
  public:
    /// Ignores fields that are not in `transforms_number_names`. `value` is NaN for other types.
    void take(std::string_view field, double value) {
        const auto found = std::ranges::find(transforms_number_names, field);
        if (found != transforms_number_names.end())
            values_[static_cast<std::size_t>(found - transforms_number_names.begin())] = value;
    }

    std::vector<number_field> list() const {
        std::vector<number_field> found;
        found.reserve(static_cast<std::size_t>(
            std::ranges::count_if(values_, [](const auto& value) { return value.has_value(); })));
        for (std::size_t i = 0; i < values_.size(); ++i)
            if (values_[i]) found.push_back({static_cast<transforms_number>(i), *values_[i]});
        return found;
    }

  private:
    std::array<std::optional<double>, transforms_number_names.size()> values_;
};

transforms_lens lens_called(const std::string* name, const std::string& where) {
    if (!name) throw error(where + ": camera_model is not a string");
    if (*name == "EQUIRECTANGULAR") return transforms_lens::panorama;  // nerfstudio's name
    return camera_model_named(*name, where).is_fisheye ? transforms_lens::fisheye : transforms_lens::opencv;
}

/// Collects frames and numbers while the parser reads the file. The number of steps to a value
/// tells its level: top (1), frame (2), field of a frame (3), row (4), cell (5).
class collector final : public json_events {
  public:
    static constexpr std::size_t deepest = 5;

    explicit collector(transforms& into) : all_(into) {}

    void finish() {
        if (!has_frames_) throw error(all_.where + ": the field frames is missing");
        all_.numbers = numbers_.list();
    }

    void begin(const json_path& path, bool is_object) override {
        if (path.empty() && !is_object) throw error(all_.where + " is not a JSON object");
        if (path.size() == 1) begin_top_field(path, is_object);
        if (!in_frames(path)) return;
        if (path.size() == 2) begin_frame(is_object);
        if (path.size() == 3) begin_frame_field(path[2].key, is_object);
        if (path.size() == 4 && in_matrix(path)) {
            frame_.is_valid &= !is_object;
            frame_.column = 0;
        }
    }

    void value(const json_path& path, const json_value& one) override {
        if (path.empty()) throw error(all_.where + " is not a JSON object");
        if (path.size() == 1) take_top_field(path[0].key, one);
        if (!in_frames(path)) return;
        if (path.size() == 2) begin_frame(false);
        if (path.size() == 3) take_frame_field(path[2].key, one);
        if (path.size() == 4 && in_matrix(path)) frame_.is_valid = false;
        if (path.size() == 5 && in_matrix(path)) take_cell(one.number);
    }

    void end(const json_path& path) override {
        if (!in_frames(path)) return;
        if (path.size() == 4 && in_matrix(path)) {
            frame_.is_valid &= frame_.column == 4;
            ++frame_.row;
        }
        if (path.size() == 3 && in_matrix(path)) frame_.is_valid &= frame_.row == 4;
        if (path.size() == 2) finish_frame();
    }

  private:
    static bool in_frames(const json_path& path) { return path.size() >= 2 && path[0].key == "frames"; }
    static bool in_matrix(const json_path& path) { return path[2].key == "transform_matrix"; }

    void begin_top_field(const json_path& path, bool is_object) {
        if (path[0].key != "frames") return take_top_field(path[0].key, {});
        if (is_object) throw error(all_.where + ": frames is not an array");
        if (has_frames_) throw error(all_.where + " has the field frames twice");
        has_frames_ = true;
    }

    void take_top_field(const std::string& field, const json_value& one) {
        if (field == "frames") throw error(all_.where + ": frames is not an array");
        if (field == "camera_model") {
            if (!one.is_null) all_.lens = lens_called(one.text, all_.where);
        } else if (field == "ply_file_path") {
            if (!one.is_null) all_.points = require_text(one, "ply_file_path", all_.where);
        } else {
            numbers_.take(field, one.number);
        }
    }

    void begin_frame(bool is_object) {
        all_.frames.emplace_back();
        frame_ = {};
        if (!is_object) throw error(where() + " is not a JSON object");
    }

    void begin_frame_field(const std::string& field, bool is_object) {
        if (field != "transform_matrix" || is_object) return take_frame_field(field, {});
        frame_.has_matrix = frame_.is_valid = true;
        frame_.row = 0;
    }

    void take_frame_field(const std::string& field, const json_value& one) {
        transforms_frame& frame = all_.frames.back();
        if (field == "file_path") {
            frame.path = require_text(one, "file_path", where());
            frame_.has_path = true;
        } else if (field == "transform_matrix") {
            frame_.has_matrix = true;
            frame_.is_valid = false;
        } else if (field == "mask_path") {
            if (!one.is_null) extras().mask = require_text(one, "mask_path", where());
        } else if (field == "depth_file_path") {
            if (!one.is_null) extras().depth = require_text(one, "depth_file_path", where());
        } else if (field == "camera_model") {
            if (!one.is_null) frame.lens = lens_called(one.text, where());
        } else {
            frame_.numbers.take(field, one.number);
        }
    }

    static const std::string& require_text(const json_value& one, const char* field,
                                           const std::string& where) {
        if (!one.text) throw error(where + ": " + field + " is not a string");
        return *one.text;
    }

    transforms_extras& extras() {
        auto& extras = all_.frames.back().extras;
        if (!extras) extras = std::make_unique<transforms_extras>();
        return *extras;
    }

    void take_cell(double number) {
        frame_.is_valid &= std::isfinite(number);
        if (frame_.row < 4 && frame_.column < 4)
            frame_.matrix[static_cast<int>(frame_.column)][static_cast<int>(frame_.row)] = number;
        ++frame_.column;
    }

    void finish_frame() {
        transforms_frame& frame = all_.frames.back();
        if (!frame_.has_path) throw error(where() + ": the field file_path is missing");
        if (!frame_.has_matrix) throw error(where() + ": the field transform_matrix is missing");
        if (!frame_.is_valid) throw error(where() + ": transform_matrix is not 4x4 finite numbers");
        set_pose(frame, frame_.matrix, where());
        frame.numbers = frame_.numbers.list();
    }

    std::string where() const { return all_.where_is(all_.frames.size() - 1); }

    transforms& all_;
    number_fields numbers_;
    bool has_frames_ = false;
    struct {
        number_fields numbers;
        glm::dmat4 matrix{0};
        std::size_t row = 0, column = 0;
        bool has_path = false, has_matrix = false, is_valid = false;
    } frame_;  ///< the contents of the current frame
};

std::optional<double> find_in(const std::vector<number_field>& numbers, transforms_number which) {
    const auto found = std::ranges::find(numbers, which, &number_field::which);
    if (found == numbers.end()) return std::nullopt;
    return found->value;
}

}  // namespace

std::string transforms::where_is(std::size_t index) const {
    const std::string& path = frames[index].path;
    return where + " frame " + std::to_string(index) +
           (path.empty() ? "" : " (" + sanitize_for_message(path) + ")");
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

transforms_lens transforms::lens_of(std::size_t index) const {
    const transforms_lens own = frames[index].lens;
    return own == transforms_lens::unset ? lens : own;
}

transforms read_transforms(const std::filesystem::path& file) {
    transforms result;
    result.where = file.string();
    collector all(result);
    read_json(file, collector::deepest, all);
    all.finish();
    return result;
}

}  // namespace gs
