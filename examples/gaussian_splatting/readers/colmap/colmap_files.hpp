// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "../camera_models.hpp"
#include "colmap.hpp"

namespace gs {

// Each function reads one file into its part of the model. Throws `error` with the file, and with
// the line of a text file.

void read_binary_cameras(const std::filesystem::path& file, colmap_model& model);
void read_binary_images(const std::filesystem::path& file, colmap_model& model);
void read_binary_points(const std::filesystem::path& file, colmap_model& model);
void read_binary_frames(const std::filesystem::path& file, colmap_model& model);

void read_text_cameras(const std::filesystem::path& file, colmap_model& model);
void read_text_images(const std::filesystem::path& file, colmap_model& model);
void read_text_points(const std::filesystem::path& file, colmap_model& model);
void read_text_frames(const std::filesystem::path& file, colmap_model& model);

// Binary and text files share these functions, which check a record and add it to the model.
// Messages begin with `where`.

using colmap_parameters = std::array<double, 12>;  ///< the first `parameter_count()` are used

void add_camera(colmap_model& model, std::uint32_t id, const camera_model& kind, std::uint64_t width,
                std::uint64_t height, const colmap_parameters& parameters, const std::string& where);
void add_image(colmap_model& model, std::uint32_t id, const std::array<double, 4>& quaternion,
               const std::array<double, 3>& translation, std::uint32_t camera_id, std::string_view name,
               const std::string& where);
void add_point(colmap_model& model, const std::array<double, 3>& position, glm::u8vec3 color,
               const std::string& where);

}  // namespace gs
