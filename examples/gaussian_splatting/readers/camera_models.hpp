// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gs {

/// A camera model of COLMAP. Its parameters are f or fx fy, cx, cy, and the distortion
/// coefficients.
struct camera_model {
    int id;  ///< number in COLMAP's binary files
    const char* name;
    bool two_focal_lengths;
    std::size_t distortion_count;  ///< how many of k1 k2 p1 p2 k3 to k6, or of k1 to k4 of a fisheye
    bool is_fisheye = false;

    std::size_t parameter_count() const { return (two_focal_lengths ? 4U : 3U) + distortion_count; }
};

/// Returns a camera model by id or by name. Throws `error`, which begins with `where` and lists the
/// supported models, for other models.
const camera_model& camera_model_with_id(int id, const std::string& where);
const camera_model& camera_model_named(std::string_view name, const std::string& where);

}  // namespace gs
