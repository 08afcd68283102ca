// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gs {

/// The numbers of a transforms file: said for one frame, or at the top for all that do not say it themselves.
enum class transforms_number { camera_angle_x, fl_x, fl_y, cx, cy, w, h, k1, k2, k3, k4, p1, p2 };
inline constexpr std::array<std::string_view, 13> transforms_number_names = {
    "camera_angle_x", "fl_x", "fl_y", "cx", "cy", "w", "h", "k1", "k2", "k3", "k4", "p1", "p2"};

/// What a camera_model, said for one frame or for all, comes to: OpenCV's model without k3 and k4, of which a
/// pinhole camera is a case, or its fisheye model.
enum class transforms_lens { unsaid, opencv, fisheye };

/// What a file said a number is; NaN where that was no number.
struct said_number {
    transforms_number which;
    double value;
};

struct transforms_frame {
    std::string path;        ///< of its photo, whose ending may have been left out
    std::string mask;        ///< its path; empty: none
    glm::dmat3 rotation{1};  ///< of `camera`
    glm::dvec3 translation{0};
    transforms_lens lens = transforms_lens::unsaid;
    std::vector<said_number> numbers;
};

struct transforms {
    std::string where;  ///< the file, for messages
    std::deque<transforms_frame> frames;
    transforms_lens lens = transforms_lens::unsaid;
    std::vector<said_number> numbers;

    /// "FILE frame INDEX (PATH)"
    std::string where_is(std::size_t index) const;
    /// Throws `error` naming the frame where it is said, but is no number.
    std::optional<double> number(std::size_t index, transforms_number which) const;
    bool is_fisheye(std::size_t index) const;
};

/// Reads a transforms file, and opens no photo. Throws `error` naming the file, and line or frame, where
/// something is malformed. What it allocates, at any time, is below four times the file's size and 64 KiB,
/// whatever it holds.
transforms read_transforms(const std::filesystem::path& file);

}  // namespace gs
