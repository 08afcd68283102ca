// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../camera_models.hpp"
#include "json_text.hpp"
#include "transforms_pose.hpp"

namespace gs {
namespace {

using nlohmann::json;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

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
    return camera_model_named(*name, where).is_fisheye ? transforms_lens::fisheye : transforms_lens::opencv;
}

/// The nesting level of the parser. Each level is a bracket inside the previous one.
enum class level { file, top, frames, frame, matrix, row };

level deeper(level from, int by) { return static_cast<level>(static_cast<int>(from) + by); }

/// Collects frames and numbers while nlohmann's parser reads the file, because a document tree
/// takes ten times the size of its text. Neither the parser nor this class recurses, so values may
/// nest deeply.
class reader final : public json::json_sax_t {
  public:
    /// Keeps references to both.
    reader(transforms& into, const std::string& text) : all_(into), text_(text) {}

    void finish() {
        if (!has_frames_) throw error(all_.where + ": the field frames is missing");
        all_.numbers = numbers_.list();
    }

    bool null() override {
        const bool is_text = field_ == "camera_model" || field_ == "mask_path";
        return (ignored_ == 0 && (at_ == level::top || at_ == level::frame) && is_text) ||
               value(not_a_number, nullptr);
    }
    bool boolean(bool) override { return value(not_a_number, nullptr); }
    bool number_integer(number_integer_t number) override {
        return value(static_cast<double>(number), nullptr);
    }
    bool number_unsigned(number_unsigned_t number) override {
        return value(static_cast<double>(number), nullptr);
    }
    bool number_float(number_float_t number, const string_t&) override { return value(number, nullptr); }
    bool string(string_t& text) override { return value(not_a_number, &text); }
    bool binary(binary_t&) override { return false; }  // does not occur in JSON
    bool start_object(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(false); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        field_ = name;
        return true;
    }

    bool parse_error(std::size_t byte, const std::string&, const json::exception& problem) override {
        const bool is_range = dynamic_cast<const json::out_of_range*>(&problem) != nullptr;
        throw error(all_.where + (is_range ? " holds a number that is too large" : " is not valid JSON") +
                    line_and_byte(text_, byte));
    }

  private:
    bool open(bool is_object) {
        if (ignored_ == 0 && is_expected(is_object)) {
            enter();
        } else {
            value(not_a_number, nullptr);
            ++ignored_;
        }
        return true;
    }

    bool is_expected(bool is_object) const {
        if (at_ == level::file || at_ == level::frames) return is_object;
        if (at_ == level::top) return !is_object && field_ == "frames";
        if (at_ == level::frame) return !is_object && field_ == "transform_matrix";
        return !is_object && at_ == level::matrix;
    }

    void enter() {
        at_ = deeper(at_, 1);
        if (at_ == level::frames) {
            if (has_frames_) throw error(all_.where + " has the field frames twice");
            has_frames_ = true;
        } else if (at_ == level::frame) {
            all_.frames.emplace_back();
            frame_ = {};
        } else if (at_ == level::matrix) {
            frame_.has_matrix = frame_.is_valid = true;
            frame_.row = 0;
        } else if (at_ == level::row) {
            frame_.column = 0;
        }
    }

    bool close() {
        if (ignored_ > 0) {
            --ignored_;
            return true;
        }
        if (at_ == level::row) {
            frame_.is_valid &= frame_.column == 4;
            ++frame_.row;
        } else if (at_ == level::matrix) {
            frame_.is_valid &= frame_.row == 4;
        } else if (at_ == level::frame) {
            finish_frame();
        }
        at_ = deeper(at_, -1);
        return true;
    }

    /// Handles a value whose contents are not visited. `number` is NaN, and `text` is null, for
    /// values of other types.
    bool value(double number, const std::string* text) {
        if (ignored_ > 0) return true;
        switch (at_) {
            case level::file:
                throw error(all_.where + " is not a JSON object");
            case level::top:
                if (field_ == "frames") throw error(all_.where + ": frames is not an array");
                if (field_ == "camera_model") all_.lens = lens_called(text, all_.where);
                numbers_.take(field_, number);
                break;
            case level::frames:
                all_.frames.emplace_back();
                throw error(where() + " is not a JSON object");
            case level::frame:
                take_field(number, text);
                break;
            case level::matrix:
                frame_.is_valid = false;
                break;
            case level::row:
                take_cell(number);
                break;
        }
        return true;
    }

    void take_field(double number, const std::string* text) {
        if (field_ == "file_path") {
            if (!text) throw error(where() + ": file_path is not a string");
            all_.frames.back().path = *text;
            frame_.has_path = true;
        } else if (field_ == "transform_matrix") {
            frame_.has_matrix = true;
            frame_.is_valid = false;
        } else if (field_ == "mask_path") {
            if (!text) throw error(where() + ": mask_path is not a string");
            all_.frames.back().mask = *text;
        } else if (field_ == "camera_model") {
            all_.frames.back().lens = lens_called(text, where());
        } else {
            frame_.numbers.take(field_, number);
        }
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
    const std::string& text_;
    level at_ = level::file;
    std::size_t ignored_ = 0;  ///< number of open brackets in an ignored value
    std::string field_;        ///< the last key, which names the next value
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

bool transforms::is_fisheye(std::size_t index) const {
    const transforms_lens own = frames[index].lens;
    return (own == transforms_lens::unset ? lens : own) == transforms_lens::fisheye;
}

transforms read_transforms(const std::filesystem::path& file) {
    transforms result;
    result.where = file.string();
    const std::string text = json_text(file);
    reader all(result, text);
    json::sax_parse(text, &all);
    all.finish();
    return result;
}

}  // namespace gs
