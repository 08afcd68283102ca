// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../validation.hpp"
#include "colmap_files.hpp"

namespace gs {
namespace {

constexpr std::uint64_t largest_side = 65536;

}  // namespace

void add_camera(colmap_model& model, std::uint32_t id, const camera_model& kind, std::uint64_t width,
                std::uint64_t height, const colmap_parameters& parameters, const std::string& where) {
    const std::string name = where + ": camera " + std::to_string(id);
    if (width == 0 || height == 0 || width > largest_side || height > largest_side)
        throw error(name + " has the size " + std::to_string(width) + "x" + std::to_string(height) +
                    ", but must be 1 to 65536 pixels per side");
    colmap_camera added;
    added.id = id;
    added.width = static_cast<int>(width);
    added.height = static_cast<int>(height);
    added.model_id = kind.id;
    const double* next = parameters.data();
    added.fx = *next++;
    added.fy = kind.two_focal_lengths ? *next++ : added.fx;
    added.cx = *next++;
    added.cy = *next++;
    std::copy_n(next, std::min(kind.distortion_count, added.coefficients.size()), added.coefficients.begin());
    if (kind.distortion_count > added.coefficients.size()) {
        added.k3 = next[4];
        if (next[5] != 0 || next[6] != 0 || next[7] != 0)
            throw error(name +
                        " has the coefficients k4 to k6 of FULL_OPENCV, which are not supported: run "
                        "colmap image_undistorter first");
    }
    if (!has_valid_intrinsics(added.camera(), added.distortion())) throw error(name + invalid_intrinsics);
    model.cameras.push_back(added);
}

void add_image(colmap_model& model, std::uint32_t id, const std::array<double, 4>& quaternion,
               const std::array<double, 3>& translation, std::uint32_t camera_id, std::string_view name,
               const std::string& where) {
    const auto& [w, x, y, z] = quaternion;
    const double norm = std::hypot(std::hypot(w, x), std::hypot(y, z));
    if (!std::isfinite(norm) || norm < 1e-12)
        throw error(where + ": the rotation of the image " + sanitize_for_message(name) +
                    " is zero or not finite");
    colmap_image added;
    added.id = id;
    added.camera_id = camera_id;
    added.name_begins = model.names.size();
    added.rotation = glm::dquat(w / norm, x / norm, y / norm, z / norm);
    added.translation = {translation[0], translation[1], translation[2]};
    if (!is_valid_position(added.translation))
        throw error(where + ": the translation of the image " + sanitize_for_message(name) +
                    invalid_position);
    model.names.resize(added.name_begins + name.size() + 1);
    std::ranges::copy(name, model.names.data() + added.name_begins);
    model.images.push_back(added);
}

void add_point(colmap_model& model, const std::array<double, 3>& position, glm::u8vec3 color,
               const std::string& where) {
    const glm::dvec3 place(position[0], position[1], position[2]);
    if (!is_valid_position(place)) throw error(where + ": the position of a point" + invalid_position);
    model.points.push_back({place, color});
}

}  // namespace gs
