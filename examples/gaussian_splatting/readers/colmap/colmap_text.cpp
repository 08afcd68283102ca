// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "colmap_files.hpp"

namespace gs {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Reads a text file line by line, and a line word by word. Throws `error` with the file and the
/// line.
class text_reader {
  public:
    explicit text_reader(const std::filesystem::path& file) : file_(file) {}

    /// Counts the records of the whole file, each of `lines` lines, and returns to the beginning.
    /// The argument is the shortest possible record. Returns at most the number of such records
    /// that fit into the file.
    template <class Record, std::size_t Size>
    std::size_t count_records(int lines, const char (&)[Size]) {
        constexpr std::size_t shortest = Size - 1;
        static_assert(sizeof(Record) <= 4 * shortest, "see read_colmap_model");
        std::size_t count = 0;
        while (next_record()) {
            for (int i = 1; i < lines; ++i) next_line();
            ++count;
        }
        file_.in.clear();
        file_.in.seekg(0);
        line_ = 0;
        return std::min(count, static_cast<std::size_t>(file_.size) / shortest + 1);
    }

    /// Goes to the next line, even if it is blank or a comment.
    bool next_line() {
        if (!std::getline(file_.in, text_)) {
            if (file_.in.bad()) throw error("cannot read " + file_.name);
            return false;
        }
        rest_ = trimmed(text_);
        ++line_;
        return true;
    }

    /// Goes to the next line that is neither blank nor a comment.
    bool next_record() {
        while (next_line())
            if (!rest_.empty() && rest_.front() != '#') return true;
        return false;
    }

    bool at_line_end() const { return rest_.empty(); }

    std::string_view word(const char* what) {
        if (rest_.empty()) malformed(std::string(what) + " is missing");
        const std::size_t length = std::min(rest_.find_first_of(blanks), rest_.size());
        const std::string_view taken = rest_.substr(0, length);
        rest_ = trimmed(rest_.substr(length));
        return taken;
    }

    template <class T>
    T number(const char* what) {
        const std::string_view text = word(what);
        T value{};
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (problem != std::errc() || end != text.data() + text.size())
            malformed(std::string(what) + " cannot be '" + sanitize_for_message(text) + "'");
        return value;
    }

    template <std::size_t Count>
    std::array<double, Count> doubles(const char* what) {
        std::array<double, Count> values;
        for (double& value : values) value = number<double>(what);
        return values;
    }

    std::string_view rest(const char* what) {
        if (rest_.empty()) malformed(std::string(what) + " is missing");
        return std::exchange(rest_, std::string_view());
    }

    void expect_groups_of(std::size_t size, const char* what) {
        std::size_t words = 0;
        for (; !at_line_end(); ++words) word(what);
        if (words % size != 0)
            malformed(std::string(what) + " must be groups of " + std::to_string(size) + " numbers");
    }

    [[noreturn]] void malformed(const std::string& why) const {
        throw error(where() + " is malformed: " + why);
    }

    std::string where() const { return file_.name + " line " + std::to_string(line_); }

  private:
    opened_file file_;
    std::string text_;       ///< the current line
    std::string_view rest_;  ///< its unread part
    std::size_t line_ = 0;
};

}  // namespace

void read_text_cameras(const std::filesystem::path& file, colmap_model& model) {
    text_reader reader(file);
    model.cameras.reserve(reader.count_records<colmap_camera>(1, "1 PINHOLE 1 1 1 1 1 1\n"));
    while (reader.next_record()) {
        const auto id = reader.number<std::uint32_t>("the camera's id");
        const auto kind = camera_model_named(reader.word("the camera model"), reader.where());
        const auto width = reader.number<std::uint64_t>("the width");
        const auto height = reader.number<std::uint64_t>("the height");
        colmap_parameters parameters{};
        for (std::size_t p = 0; p < kind.parameter_count(); ++p)
            parameters[p] = reader.number<double>("a camera parameter");
        if (!reader.at_line_end())
            reader.malformed(std::string(kind.name) + " has only " + std::to_string(kind.parameter_count()) +
                             " parameters");
        add_camera(model, id, kind, width, height, parameters, reader.where());
    }
}

void read_text_images(const std::filesystem::path& file, colmap_model& model) {
    text_reader reader(file);
    model.images.reserve(reader.count_records<colmap_image>(2, "1 1 0 0 0 0 0 0 1 a\n\n"));
    while (reader.next_record()) {
        const auto id = reader.number<std::uint32_t>("the image's id");
        const auto quaternion = reader.doubles<4>("a part of the rotation");
        const auto translation = reader.doubles<3>("a part of the translation");
        const auto camera_id = reader.number<std::uint32_t>("the camera's id");
        const std::string_view name = reader.rest("the image's name");
        add_image(model, id, quaternion, translation, camera_id, name, reader.where());
        if (reader.next_line()) reader.expect_groups_of(3, "the image's 2D points");
    }
}

void read_text_points(const std::filesystem::path& file, colmap_model& model) {
    text_reader reader(file);
    model.points.reserve(reader.count_records<colored_point>(1, "1 0 0 0 0 0 0 0\n"));
    while (reader.next_record()) {
        reader.number<std::uint64_t>("the point's id");
        const auto position = reader.doubles<3>("a coordinate");
        glm::u8vec3 color;
        for (int channel = 0; channel < 3; ++channel) color[channel] = reader.number<std::uint8_t>("a color");
        reader.number<double>("the reprojection error");
        reader.expect_groups_of(2, "the point's track");
        add_point(model, position, color, reader.where());
    }
}

void read_text_frames(const std::filesystem::path& file, colmap_model& model) {
    text_reader reader(file);
    while (reader.next_record()) {
        const auto id = reader.number<std::uint32_t>("the frame's id");
        reader.number<std::uint32_t>("the rig's id");
        reader.doubles<7>("a part of the rig's pose");
        for (auto left = reader.number<std::uint32_t>("the number of images"); left > 0; --left) {
            const bool is_camera = reader.word("the kind of sensor") == "CAMERA";
            reader.number<std::uint32_t>("the sensor's id");
            const auto data = reader.number<std::uint64_t>("the image's id");
            if (is_camera) model.frames.push_back({data, id});
        }
        if (!reader.at_line_end()) reader.malformed("the frame has more images than it promises");
    }
}

}  // namespace gs
