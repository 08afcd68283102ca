// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "../../scene/camera.hpp"

namespace gs {

struct polycam_camera {
    gs::camera camera;
    std::optional<double> blur_score;  ///< smaller for blurrier photos
};

/// Reads one file of `keyframes/cameras`. Throws `error` with the file, and the field that is
/// missing or malformed.
polycam_camera read_polycam_camera(const std::filesystem::path& file);

}  // namespace gs
