// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <cstring>
#include <filesystem>

#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "colmap_files.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "COLMAP's binary files are read as they lie");

/// Reads values one after another. Throws `error` if the file ends too early.
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

    /// Returns the number of records that follow. Throws `error` if the file is too short for this
    /// number of records of at least `record_size` bytes.
    std::size_t take_count(std::size_t record_size) {
        const auto count = take<std::uint64_t>();
        if (count > remaining() / record_size) truncated();
        return static_cast<std::size_t>(count);
    }

    /// Returns a view of memory that the reader owns.
    std::string_view take_name() {
        const std::size_t end = bytes_.find('\0', position_);
        if (end == std::string::npos) truncated();
        const std::string_view name = std::string_view(bytes_).substr(position_, end - position_);
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

}  // namespace

void read_binary_cameras(const std::filesystem::path& file, colmap_model& model) {
    binary_reader reader(file);
    const std::size_t count = reader.take_count(4 + 4 + 8 + 8 + 3 * 8);
    model.cameras.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto id = reader.take<std::uint32_t>();
        const auto& kind = camera_model_with_id(reader.take<std::int32_t>(), reader.file());
        const auto width = reader.take<std::uint64_t>();
        const auto height = reader.take<std::uint64_t>();
        colmap_parameters parameters{};
        for (std::size_t p = 0; p < kind.parameter_count(); ++p) parameters[p] = reader.take<double>();
        add_camera(model, id, kind, width, height, parameters, reader.file());
    }
    reader.expect_end();
}

void read_binary_images(const std::filesystem::path& file, colmap_model& model) {
    constexpr std::size_t track_point = 8 + 8 + 8;
    binary_reader reader(file);
    const std::size_t count = reader.take_count(4 + 7 * 8 + 4 + 1 + 8);
    model.images.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto id = reader.take<std::uint32_t>();
        const auto quaternion = reader.take_doubles<4>();
        const auto translation = reader.take_doubles<3>();
        const auto camera_id = reader.take<std::uint32_t>();
        add_image(model, id, quaternion, translation, camera_id, reader.take_name(), reader.file());
        reader.skip_records(track_point);
    }
    reader.expect_end();
}

void read_binary_points(const std::filesystem::path& file, colmap_model& model) {
    constexpr std::size_t track_element = 4 + 4;
    binary_reader reader(file);
    const std::size_t count = reader.take_count(8 + 3 * 8 + 3 + 8 + 8);
    model.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        reader.take<std::uint64_t>();  // its id
        const auto position = reader.take_doubles<3>();
        glm::u8vec3 color;
        for (int channel = 0; channel < 3; ++channel) color[channel] = reader.take<std::uint8_t>();
        reader.take<double>();  // its reprojection error
        reader.skip_records(track_element);
        add_point(model, position, color, reader.file());
    }
    reader.expect_end();
}

void read_binary_frames(const std::filesystem::path& file, colmap_model& model) {
    constexpr std::int32_t camera = 0;  // the other kinds of sensors have no images
    binary_reader reader(file);
    const std::size_t count = reader.take_count(4 + 4 + 7 * 8 + 4);
    for (std::size_t i = 0; i < count; ++i) {
        const auto id = reader.take<std::uint32_t>();
        reader.take<std::uint32_t>();  // the rig's id
        reader.take_doubles<7>();      // the rig's pose; those of images include it
        const auto sensors = reader.take<std::uint32_t>();
        for (std::uint32_t k = 0; k < sensors; ++k) {
            const auto kind = reader.take<std::int32_t>();
            reader.take<std::uint32_t>();  // the sensor's id
            const auto data = reader.take<std::uint64_t>();
            if (kind == camera) model.frames.push_back({data, id});
        }
    }
    reader.expect_end();
}

}  // namespace gs
