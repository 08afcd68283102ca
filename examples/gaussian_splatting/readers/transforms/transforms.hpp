// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gs {

/// The numbers of a transforms file. A frame may have its own; otherwise the one at the top level
/// applies.
enum class transforms_number { camera_angle_x, fl_x, fl_y, cx, cy, w, h, k1, k2, k3, k4, p1, p2 };
inline constexpr std::array<std::string_view, 13> transforms_number_names = {
    "camera_angle_x", "fl_x", "fl_y", "cx", "cy", "w", "h", "k1", "k2", "k3", "k4", "p1", "p2"};

/// The `camera_model` of a frame or of the whole file: OpenCV's model without k3 and k4, which
/// includes pinhole cameras, OpenCV's fisheye model, or a panorama.
enum class transforms_lens { unset, opencv, fisheye, panorama };

/// A number in the file, or NaN for a value of another type.
struct number_field {
    transforms_number which;
    double value;
};

/// Files that few frames have.
struct transforms_extras {
    std::string mask;   ///< path of the mask, or empty
    std::string depth;  ///< path of the depth map, or empty
};

struct transforms_frame {
    std::string path;                           ///< path of the photo, possibly without the ending
    std::unique_ptr<transforms_extras> extras;  ///< null if it has none
    glm::dmat3 rotation{1};                     ///< rotation of the camera pose: see `camera`
    glm::dvec3 translation{0};
    transforms_lens lens = transforms_lens::unset;
    std::vector<number_field> numbers;
};

struct transforms {
    std::string where;  ///< name of the file, for messages
    std::deque<transforms_frame> frames;
    std::string points;  ///< path of the PLY file with points, or empty
    transforms_lens lens = transforms_lens::unset;
    std::vector<number_field> numbers;

    /// Returns "FILE frame INDEX (PATH)" for messages.
    std::string where_is(std::size_t index) const;
    /// Returns the number of a frame, the file's number if the frame has none, or nothing if
    /// neither has one. Throws `error` with the frame if the value is not a number.
    std::optional<double> number(std::size_t index, transforms_number which) const;
    /// Returns the lens of a frame; `unset` if neither the frame nor the file has one.
    transforms_lens lens_of(std::size_t index) const;
};

/// Reads a transforms file without opening photos. Throws `error` with the file, and the line or
/// frame, that is malformed. Allocates at most four times the size of the file plus 64 KiB, also
/// for malformed files.
transforms read_transforms(const std::filesystem::path& file);

}  // namespace gs
