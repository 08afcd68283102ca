// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "../scene/camera.hpp"

namespace gs::live {

/// What a frame shows.
enum class overlay {
    none,   ///< the model
    error,  ///< the mean absolute error of the colors of a training view
    depth   ///< inverse depth: near is bright
};
constexpr std::array<std::string_view, 3> names_of(overlay) { return {"none", "error", "depth"}; }

inline constexpr int least_side = 16, most_side = 2048;  ///< sides of a frame in pixels

/// A frame that a page asks for. Positions and directions are in internal coordinates.
struct view_request {
    int width = 0, height = 0;  ///< in pixels; largest size if `view` is set
    live::overlay overlay = live::overlay::none;
    std::optional<std::size_t> view;  ///< draws this training view; the camera below is not used
    glm::dvec3 position{0}, forward{0, 0, 1}, up{0, -1, 0};
    double field_of_view = 0.8;  ///< of the height, in radians
};

/// Returns the value of a parameter of a request; empty if it is missing.
using parameter_lookup = std::function<std::string(const char* name)>;

/// Reads a request of a page: see docs/how-to/watch_a_training.md. Clamps the size. Throws `error`
/// for numbers that are malformed, not finite or out of range, and for views from `views` on.
view_request read_view_request(const parameter_lookup& parameter, std::size_t views);

/// Returns the camera of a request without `view`.
camera camera_of(const view_request& request);

}  // namespace gs::live
