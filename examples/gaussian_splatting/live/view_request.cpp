// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "view_request.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "../scene/look_at.hpp"

namespace gs::live {
namespace {

constexpr double farthest = 1e6;  ///< largest magnitude of a coordinate

[[noreturn]] void refuse(const char* name, std::string_view text, const std::string& expected) {
    throw error("the parameter " + std::string(name) + " must be " + expected + ", not '" +
                sanitize_for_message(text) + "'");
}

double number_in(std::string_view text, const char* name, double least, double most) {
    double value = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = failed == std::errc{} && end == text.data() + text.size();
    if (!is_number || !(value >= least && value <= most))
        refuse(name, text, "a number from " + std::to_string(least) + " to " + std::to_string(most));
    return value;
}

/// Reads three numbers, separated by commas.
glm::dvec3 vector_in(const std::string& text, const char* name) {
    glm::dvec3 all{0};
    std::string_view left = text;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = left.find(',');
        if ((comma == std::string_view::npos) != (axis == 2)) refuse(name, text, "three numbers");
        all[axis] = number_in(left.substr(0, comma), name, -farthest, farthest);
        left.remove_prefix(axis < 2 ? comma + 1 : 0);
    }
    return all;
}

int side_in(const std::string& text, const char* name) {
    return static_cast<int>(std::clamp<double>(number_in(text, name, 0, farthest), least_side, most_side));
}

overlay overlay_named(const std::string& text) {
    const auto names = names_of(overlay{});
    const auto found = std::ranges::find(names, text);
    if (found == names.end()) refuse("overlay", text, "none, error or depth");
    return static_cast<overlay>(found - names.begin());
}

/// Checks that the camera has axes.
void require_axes(const view_request& request) {
    constexpr double least_sine = 1e-4;
    const double lengths = glm::length(request.forward) * glm::length(request.up);
    if (!(glm::length(glm::cross(request.forward, request.up)) > least_sine * lengths))
        throw error("the parameters forward and up must be vectors of different directions");
}

}  // namespace

view_request read_view_request(const parameter_lookup& parameter, std::size_t views) {
    view_request request;
    request.width = side_in(parameter("width"), "width");
    request.height = side_in(parameter("height"), "height");
    request.overlay = overlay_named(parameter("overlay"));
    if (const std::string view = parameter("view"); !view.empty()) {
        if (views == 0) throw error("the parameter view needs a training");
        request.view = static_cast<std::size_t>(number_in(view, "view", 0, static_cast<double>(views - 1)));
        return request;
    }
    if (request.overlay == overlay::error)
        throw error("the parameter overlay may be error only if the parameter view is set");
    request.position = vector_in(parameter("position"), "position");
    request.forward = vector_in(parameter("forward"), "forward");
    request.up = vector_in(parameter("up"), "up");
    request.field_of_view = number_in(parameter("field_of_view"), "field_of_view", 0.01, 2.8);
    require_axes(request);
    return request;
}

camera camera_of(const view_request& request) {
    const double focal = 0.5 * request.height / std::tan(0.5 * request.field_of_view);
    camera c = look_at(request.position, request.position + glm::normalize(request.forward), request.up,
                       request.height, focal);
    c.width = request.width;
    c.cx = 0.5 * request.width;
    return c;
}

}  // namespace gs::live
