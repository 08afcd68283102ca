// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <string>

#include "../core/file_bytes.hpp"
#include "../core/parse_json.hpp"

namespace gs::video {
namespace {

using json = nlohmann::ordered_json;

constexpr std::uintmax_t most_bytes = 64 << 20;
constexpr double farthest = 1e12;                 ///< largest magnitude of a coordinate
constexpr double least_sine = 1e-6;               ///< of the angle between two axes
constexpr double most_degrees = 170;              ///< of a field of view
constexpr int least_side = 16, most_side = 8192;  ///< of images, in pixels

/// The values of a path's file. Errors name the file and the value.
class path_file {
  public:
    explicit path_file(const std::filesystem::path& file) : name_(file.string()) {
        if (std::error_code failed; std::filesystem::file_size(file, failed) > most_bytes && !failed)
            throw error(name_ + " is too large for a camera path");
        content_ = parse_json(file_bytes(file), "the camera path " + name_);
        if (!content_.is_object()) refuse("the file", "an object");
    }

    [[noreturn]] void refuse(const std::string& what, const std::string& expected) const {
        throw error("the camera path " + name_ + ": " + what + " must be " + expected);
    }
    const json* find(const json& in, const char* key) const {
        const auto found = in.is_object() ? in.find(key) : in.end();
        return found == in.end() || found->is_null() ? nullptr : &*found;
    }
    double number(const json* value, const std::string& what, double least, double most) const {
        const double n = value && value->is_number() ? value->get<double>() : NAN;
        if (!(n >= least && n <= most)) refuse(what, "a number from " + text(least) + " to " + text(most));
        return n;
    }
    std::vector<double> numbers(const json* value, const std::string& what, std::size_t count) const {
        if (!value || !value->is_array() || value->size() != count)
            refuse(what, "a list of " + std::to_string(count) + " numbers");
        std::vector<double> all;
        for (const json& one : *value) all.push_back(number(&one, what, -farthest, farthest));
        return all;
    }
    glm::dvec3 vector(const json& in, const char* key, const std::string& what) const {
        const auto v = numbers(find(in, key), what + "." + key, 3);
        return {v[0], v[1], v[2]};
    }
    const json& content() const { return content_; }

  private:
    static std::string text(double value) {
        const std::string digits = json(value).dump();
        return digits.ends_with(".0") ? digits.substr(0, digits.size() - 2) : digits;
    }

    std::string name_;
    json content_;
};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

glm::dquat axes_from(const path_file& file, glm::dvec3 forward, glm::dvec3 up, const std::string& what) {
    const double lengths = glm::length(forward) * glm::length(up);
    const glm::dvec3 right = glm::cross(forward, up);
    if (!(glm::length(right) > least_sine * lengths)) file.refuse(what, "a camera with three axes");
    const glm::dvec3 x = glm::normalize(right), z = glm::normalize(forward);
    return glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
}

/// A camera of nerfstudio: a matrix of rows from camera axes (x right, y up, z backward) to world.
key_view nerfstudio_view(const path_file& file, const json& entry, const std::string& what) {
    const auto m = file.numbers(file.find(entry, "camera_to_world"), what + ".camera_to_world", 16);
    key_view view;
    view.position = {m[3], m[7], m[11]};
    view.axes = axes_from(file, {-m[2], -m[6], -m[10]}, {m[1], m[5], m[9]}, what + ".camera_to_world");
    view.field_of_view = radians(file.number(file.find(entry, "fov"), what + ".fov", 1, most_degrees));
    return view;
}

key_view own_view(const path_file& file, const json& entry, const std::string& what) {
    key_view view;
    view.position = file.vector(entry, "position", what);
    view.axes = axes_from(file, file.vector(entry, "look_at", what) - view.position,
                          file.vector(entry, "up", what), what);
    constexpr double usual_degrees = 45;
    const json* degrees = file.find(entry, "field_of_view");
    view.field_of_view =
        radians(degrees ? file.number(degrees, what + ".field_of_view", 1, most_degrees) : usual_degrees);
    return view;
}

/// Returns the point of the curve through b and c, with neighbors a and d, at t in [0, 1].
glm::dvec3 on_curve(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                    double t) {
    return 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                  t * t * t * (3.0 * (b - c) + d - a));
}

}  // namespace

key_view camera_path::at(double share) const {
    const auto last = static_cast<double>(views.size() - 1);
    const double time = std::clamp(share, 0.0, 1.0) * last;
    const auto before = static_cast<std::ptrdiff_t>(std::min(std::floor(time), std::max(last - 1, 0.0)));
    const double t = time - static_cast<double>(before);
    const auto view = [&](std::ptrdiff_t offset) -> const key_view& {
        const std::ptrdiff_t end = static_cast<std::ptrdiff_t>(views.size()) - 1;
        return views[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(before + offset, 0, end))];
    };
    return {on_curve(view(-1).position, view(0).position, view(1).position, view(2).position, t),
            glm::slerp(view(0).axes, view(1).axes, t),
            std::lerp(view(0).field_of_view, view(1).field_of_view, t)};
}

camera_path read_camera_path(const std::filesystem::path& name) {
    const path_file file(name);
    const json& content = file.content();
    const bool is_nerfstudio = content.contains("camera_path");
    const char* list = is_nerfstudio ? "camera_path" : "cameras";
    const json* entries = file.find(content, list);
    if (!entries || !entries->is_array() || entries->empty())
        file.refuse("camera_path or cameras", "a list of cameras");
    camera_path path;
    for (std::size_t i = 0; i < entries->size(); ++i) {
        const std::string what = std::string(list) + "[" + std::to_string(i) + "]";
        path.views.push_back(is_nerfstudio ? nerfstudio_view(file, (*entries)[i], what)
                                           : own_view(file, (*entries)[i], what));
    }
    if (const json* seconds = file.find(content, "seconds"))
        path.seconds = file.number(seconds, "seconds", 0.01, 1e5);
    const auto side = [&](const char* key) -> std::optional<int> {
        const json* value = file.find(content, key);
        if (!value) return {};
        return static_cast<int>(file.number(value, key, least_side, most_side));
    };
    path.width = side(is_nerfstudio ? "render_width" : "width");
    path.height = side(is_nerfstudio ? "render_height" : "height");
    return path;
}

camera camera_of(const key_view& view, const normalization& normalization, int width, int height) {
    camera c;
    c.width = width;
    c.height = height;
    c.fx = c.fy = 0.5 * height / std::tan(0.5 * view.field_of_view);
    c.cx = 0.5 * width;
    c.cy = 0.5 * height;
    c.rotation = glm::transpose(glm::mat3_cast(view.axes));
    c.translation = -(c.rotation * normalization.to_internal(view.position));
    return c;
}

}  // namespace gs::video
