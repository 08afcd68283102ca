// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "../scene/scene.hpp"

namespace gs::stereo {

/// A photo at the size at which stereo compares it.
struct small_view {
    gs::camera camera;
    std::vector<float> brightness;   ///< mean of the channels in [0, 1], by pixel
    std::vector<glm::u8vec3> color;  ///< by pixel
    std::vector<float> is_usable;    ///< 1 or 0, by pixel; 0 if it is masked or transparent
    std::vector<glm::vec3> ray;      ///< unit vector in world space through the center of each pixel

    std::size_t width() const { return static_cast<std::size_t>(camera.width); }
    std::size_t height() const { return static_cast<std::size_t>(camera.height); }
    std::size_t pixels() const { return width() * height(); }
};

/// Returns the photo of a view, reduced so that its longer side has at most `longer_side` pixels.
small_view reduced(const view& of, int longer_side);

}  // namespace gs::stereo
