// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "colmap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "../error.hpp"
#include "file_bytes.hpp"
#include "views.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "COLMAP's binary files are read as they lie");

constexpr std::uint64_t largest_side = 65536;

// --------------------------------------------------------------------------------------- camera models

struct camera_model {
    int id;
    const char* name;
    bool two_focal_lengths;
    std::size_t distortion_count;  ///< of k1, k2, p1, p2 in this order

    std::size_t parameter_count() const { return (two_focal_lengths ? 4U : 3U) + distortion_count; }
};

constexpr camera_model camera_models[] = {
    {0, "SIMPLE_PINHOLE", false, 0}, {1, "PINHOLE", true, 0}, {2, "SIMPLE_RADIAL", false, 1},
    {3, "RADIAL", false, 2},         {4, "OPENCV", true, 4},
};

template <class Key>
const camera_model& find_model(const Key& key, const std::string& shown, const std::string& where) {
    std::string supported;
    for (const camera_model& model : camera_models) {
        if constexpr (std::is_integral_v<Key>) {
            if (model.id == key) return model;
        } else if (model.name == key) {
            return model;
        }
        supported += (supported.empty() ? "" : ", ") + std::string(model.name);
    }
    throw error(where + ": the camera model " + shown + " is unknown; supported are " + supported);
}

colmap_camera make_camera(std::uint32_t id, const camera_model& model, std::uint64_t width,
                          std::uint64_t height, std::span<const double> parameters,
                          const std::string& where) {
    const std::string name = where + ": camera " + std::to_string(id);
    if (width == 0 || height == 0 || width > largest_side || height > largest_side)
        throw error(name + " has the size " + std::to_string(width) + "x" + std::to_string(height) +
                    ", which no photo has");
    colmap_camera result;
    result.id = id;
    result.model = model.name;
    camera& pinhole = result.intrinsics;
    pinhole.width = static_cast<int>(width);
    pinhole.height = static_cast<int>(height);
    pinhole.fx = parameters[0];
    pinhole.fy = parameters[model.two_focal_lengths ? 1 : 0];
    const auto centre = parameters.subspan(model.two_focal_lengths ? 2 : 1);
    pinhole.cx = centre[0];
    pinhole.cy = centre[1];
    double* const coefficients[] = {&result.distortion.k1, &result.distortion.k2, &result.distortion.p1,
                                    &result.distortion.p2};
    for (std::size_t i = 0; i < model.distortion_count; ++i) *coefficients[i] = centre[2 + i];
    if (!has_sound_intrinsics(pinhole, result.distortion))
        throw error(name + " has a focal length that is not positive, or a parameter that is not finite");
    return result;
}

colmap_image make_image(std::span<const double, 4> quaternion, std::span<const double, 3> translation,
                        std::uint32_t camera_id, std::string name, const std::string& where) {
    const double norm =
        std::hypot(std::hypot(quaternion[0], quaternion[1]), std::hypot(quaternion[2], quaternion[3]));
    if (!std::isfinite(norm) || norm < 1e-12)
        throw error(where + ": the rotation of the image " + name + " is zero or not finite");
    if (!std::ranges::all_of(translation, [](double x) { return std::isfinite(x); }))
        throw error(where + ": the translation of the image " + name + " is not finite");
    colmap_image result;
    result.name = std::move(name);
    result.camera_id = camera_id;
    result.rotation = glm::mat3_cast(
        glm::dquat(quaternion[0] / norm, quaternion[1] / norm, quaternion[2] / norm, quaternion[3] / norm));
    result.translation = {translation[0], translation[1], translation[2]};
    return result;
}

coloured_point make_point(glm::dvec3 position, glm::u8vec3 colour, const std::string& where) {
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
        throw error(where + ": the position of a point is not finite");
    return {position, colour};
}

// -------------------------------------------------------------------------------------- binary files

/// Reads values one after another and throws `error` rather than pass the file's end.
class binary_reader {
  public:
    explicit binary_reader(const std::filesystem::path& file)
        : file_(file.string()), bytes_(file_bytes(file)) {}

    template <class T>
    T take() {
        need(sizeof(T));
        T value;
        std::memcpy(&value, bytes_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        return value;
    }

    template <std::size_t Count>
    std::array<double, Count> take_doubles() {
        std::array<double, Count> values;
        for (double& value : values) value = take<double>();
        return values;
    }

    /// The number of records that follow, each of at least `record_size` bytes: never more than can follow.
    std::size_t take_count(std::size_t record_size) {
        const auto count = take<std::uint64_t>();
        if (count > remaining() / record_size) truncated();
        return static_cast<std::size_t>(count);
    }

    std::string take_name() {
        const std::size_t end = bytes_.find('\0', position_);
        if (end == std::string::npos) truncated();
        std::string name = bytes_.substr(position_, end - position_);
        position_ = end + 1;
        return name;
    }

    void skip_records(std::size_t record_size) { position_ += take_count(record_size) * record_size; }

    void expect_end() const {
        if (remaining() > 0)
            throw error(file_ + " is too long: " + std::to_string(remaining()) +
                        " bytes follow its last record");
    }

    const std::string& file() const { return file_; }

  private:
    std::size_t remaining() const { return bytes_.size() - position_; }
    void need(std::size_t count) const {
        if (count > remaining()) truncated();
    }
    [[noreturn]] void truncated() const {
        throw error(file_ + " is truncated: it promises more than its " + std::to_string(bytes_.size()) +
                    " bytes");
    }

    std::string file_;
    std::string bytes_;
    std::size_t position_ = 0;
};

std::vector<colmap_camera> read_binary_cameras(const std::filesystem::path& file) {
    binary_reader reader(file);
    const std::size_t count = reader.take_count(4 + 4 + 8 + 8 + 3 * 8);
    std::vector<colmap_camera> cameras;
    cameras.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto id = reader.take<std::uint32_t>();
        const auto model_id = reader.take<std::int32_t>();
        const auto width = reader.take<std::uint64_t>();
        const auto height = reader.take<std::uint64_t>();
        const camera_model model = find_model(model_id, "number " + std::to_string(model_id), reader.file());
        std::vector<double> parameters(model.parameter_count());
        for (double& parameter : parameters) parameter = reader.take<double>();
        cameras.push_back(make_camera(id, model, width, height, parameters, reader.file()));
    }
    reader.expect_end();
    return cameras;
}

std::vector<colmap_image> read_binary_images(const std::filesystem::path& file) {
    constexpr std::size_t track_point = 8 + 8 + 8;
    binary_reader reader(file);
    const std::size_t count = reader.take_count(4 + 7 * 8 + 4 + 1 + 8);
    std::vector<colmap_image> images;
    images.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        reader.take<std::uint32_t>();  // the image's id, which nothing refers to here
        const auto quaternion = reader.take_doubles<4>();
        const auto translation = reader.take_doubles<3>();
        const auto camera_id = reader.take<std::uint32_t>();
        images.push_back(make_image(quaternion, translation, camera_id, reader.take_name(), reader.file()));
        reader.skip_records(track_point);
    }
    reader.expect_end();
    return images;
}

std::vector<coloured_point> read_binary_points(const std::filesystem::path& file) {
    constexpr std::size_t track_element = 4 + 4;
    binary_reader reader(file);
    const std::size_t count = reader.take_count(8 + 3 * 8 + 3 + 8 + 8);
    std::vector<coloured_point> points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        reader.take<std::uint64_t>();  // its id
        const auto position = reader.take_doubles<3>();
        glm::u8vec3 colour;
        for (int channel = 0; channel < 3; ++channel) colour[channel] = reader.take<std::uint8_t>();
        reader.take<double>();  // its reprojection error
        reader.skip_records(track_element);
        points.push_back(make_point({position[0], position[1], position[2]}, colour, reader.file()));
    }
    reader.expect_end();
    return points;
}

// ---------------------------------------------------------------------------------------- text files

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Reads a text file line by line, and a line word by word; throws `error` naming file and line.
class text_reader {
  public:
    explicit text_reader(const std::filesystem::path& file)
        : file_(file.string()), bytes_(file_bytes(file)) {}

    /// Goes to the next line, whatever it holds.
    bool next_line() {
        if (position_ >= bytes_.size()) return false;
        const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
        rest_ = trimmed(std::string_view(bytes_).substr(position_, end - position_));
        position_ = end + 1;
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
            malformed(std::string(what) + " cannot be '" + std::string(text) + "'");
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

    std::string where() const { return file_ + " line " + std::to_string(line_); }

  private:
    std::string file_;
    std::string bytes_;
    std::string_view rest_;
    std::size_t position_ = 0;
    std::size_t line_ = 0;
};

std::vector<colmap_camera> read_text_cameras(const std::filesystem::path& file) {
    text_reader reader(file);
    std::vector<colmap_camera> cameras;
    while (reader.next_record()) {
        const auto id = reader.number<std::uint32_t>("the camera's id");
        const std::string_view name = reader.word("the camera model");
        const camera_model model = find_model(name, std::string(name), reader.where());
        const auto width = reader.number<std::uint64_t>("the width");
        const auto height = reader.number<std::uint64_t>("the height");
        std::vector<double> parameters(model.parameter_count());
        for (double& parameter : parameters) parameter = reader.number<double>("a camera parameter");
        if (!reader.at_line_end())
            reader.malformed(std::string(name) + " has only " + std::to_string(parameters.size()) +
                             " parameters");
        cameras.push_back(make_camera(id, model, width, height, parameters, reader.where()));
    }
    return cameras;
}

std::vector<colmap_image> read_text_images(const std::filesystem::path& file) {
    text_reader reader(file);
    std::vector<colmap_image> images;
    while (reader.next_record()) {
        reader.number<std::uint32_t>("the image's id");
        const auto quaternion = reader.doubles<4>("a part of the rotation");
        const auto translation = reader.doubles<3>("a part of the translation");
        const auto camera_id = reader.number<std::uint32_t>("the camera's id");
        const std::string_view name = reader.rest("the image's name");
        images.push_back(make_image(quaternion, translation, camera_id, std::string(name), reader.where()));
        if (reader.next_line()) reader.expect_groups_of(3, "the image's 2D points");
    }
    return images;
}

std::vector<coloured_point> read_text_points(const std::filesystem::path& file) {
    text_reader reader(file);
    std::vector<coloured_point> points;
    while (reader.next_record()) {
        reader.number<std::uint64_t>("the point's id");
        const auto position = reader.doubles<3>("a coordinate");
        glm::u8vec3 colour;
        for (int channel = 0; channel < 3; ++channel)
            colour[channel] = reader.number<std::uint8_t>("a colour");
        reader.number<double>("the reprojection error");
        reader.expect_groups_of(2, "the point's track");
        points.push_back(make_point({position[0], position[1], position[2]}, colour, reader.where()));
    }
    return points;
}

// ----------------------------------------------------------------------------------------- the model

/// `stem.bin`, or else `stem.txt`, or else nothing.
std::filesystem::path find_part(const std::filesystem::path& folder, const std::string& stem) {
    for (const char* ending : {".bin", ".txt"})
        if (const auto file = folder / (stem + ending); std::filesystem::exists(file)) return file;
    return {};
}

std::filesystem::path require_part(const std::filesystem::path& folder, const std::string& stem) {
    auto file = find_part(folder, stem);
    if (file.empty())
        throw error("the COLMAP model " + folder.string() + " has no " + stem + ": neither " + stem +
                    ".bin nor " + stem + ".txt is there");
    return file;
}

bool is_binary(const std::filesystem::path& file) { return file.extension() == ".bin"; }

std::filesystem::path model_folder(const std::filesystem::path& data) {
    const auto sparse = data / "sparse";
    return std::filesystem::is_directory(sparse / "0") ? sparse / "0" : sparse;
}

std::map<std::uint32_t, const colmap_camera*> by_id(const std::vector<colmap_camera>& cameras) {
    std::map<std::uint32_t, const colmap_camera*> found;
    for (const colmap_camera& one : cameras) found.emplace(one.id, &one);
    return found;
}

std::vector<recorded_view> recorded_views(const colmap_model& model, const std::filesystem::path& photos) {
    const auto cameras = by_id(model.cameras);
    std::vector<recorded_view> recorded;
    recorded.reserve(model.images.size());
    for (const colmap_image& taken : model.images) {
        const auto found = cameras.find(taken.camera_id);
        if (found == cameras.end())
            throw error(model.images_file.string() + ": the image " + taken.name + " refers to camera " +
                        std::to_string(taken.camera_id) + ", which is not there");
        recorded_view one{photos / taken.name, taken.name, found->second->intrinsics,
                          found->second->distortion, found->second->model};
        one.camera.rotation = taken.rotation;
        one.camera.translation = taken.translation;
        recorded.push_back(std::move(one));
    }
    std::ranges::sort(recorded, {}, &recorded_view::name);
    return recorded;
}

}  // namespace

colmap_model read_colmap_model(const std::filesystem::path& folder) {
    const auto cameras = require_part(folder, "cameras");
    const auto images = require_part(folder, "images");
    const auto points = find_part(folder, "points3D");
    colmap_model model;
    model.images_file = images;
    model.cameras = is_binary(cameras) ? read_binary_cameras(cameras) : read_text_cameras(cameras);
    if (model.cameras.empty()) throw error(cameras.string() + " lists no cameras");
    model.images = is_binary(images) ? read_binary_images(images) : read_text_images(images);
    if (model.images.empty()) throw error(images.string() + " lists no images");
    if (!points.empty())
        model.points = is_binary(points) ? read_binary_points(points) : read_text_points(points);
    return model;
}

scene load_colmap_scene(const load_options& options, const log_function& log) {
    if (options.eval && options.test_every < 1)
        throw error("test_every must be at least 1, not " + std::to_string(options.test_every));
    const std::filesystem::path data = options.data, photos = data / options.images;
    colmap_model model = read_colmap_model(model_folder(data));
    const auto recorded = recorded_views(model, photos);
    if (!std::filesystem::is_directory(photos))
        throw error("the folder of photos " + photos.string() + " does not exist");
    scene result;
    result.source = "COLMAP";
    result.points = std::move(model.points);
    if (result.points.empty()) log("the COLMAP model has no points");
    std::vector<view> views = load_views(recorded, options, log);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const bool held_out = options.eval && i % static_cast<std::size_t>(options.test_every) == 0;
        (held_out ? result.test : result.train).push_back(std::move(views[i]));
    }
    return result;
}

}  // namespace gs
