// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "polycam_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "../../core/error.hpp"
#include "../json_events.hpp"
#include "../validation.hpp"

namespace gs {
namespace {

constexpr std::array<std::string_view, 19> names = {
    "t_00", "t_01", "t_02", "t_03", "t_10", "t_11", "t_12",  "t_13",   "t_20",      "t_21",
    "t_22", "t_23", "fx",   "fy",   "cx",   "cy",   "width", "height", "blur_score"};

constexpr std::size_t index_of(std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

/// Collects the numbers of the file.
class fields final : public json_events {
  public:
    explicit fields(std::string where) : where_(std::move(where)) {}

    void begin(const json_path&, bool is_object) override {
        if (!is_object) throw error(where_ + " is not a JSON object");
    }

    void value(const json_path& path, const json_value& one) override {
        if (path.empty()) throw error(where_ + " is not a JSON object");
        const std::size_t index = index_of(path[0].key);
        if (index == names.size()) return;
        if (!std::isfinite(one.number)) throw error(where_ + ": " + path[0].key + " is not a number");
        values_[index] = one.number;
    }

    std::optional<double> find(std::string_view name) const { return values_[index_of(name)]; }

    double number(std::string_view name) const {
        const auto found = find(name);
        if (!found) throw error(where_ + ": the field " + std::string(name) + " is missing");
        return *found;
    }

    int side(std::string_view name) const {
        const double value = number(name);
        if (!(value >= 1 && value <= 65536) || value != std::floor(value))
            throw error(where_ + ": " + std::string(name) + " is " + std::to_string(value) +
                        ", but must be a whole number from 1 to 65536");
        return static_cast<int>(value);
    }

    /// Returns row `row` of the camera-to-world matrix.
    std::array<double, 4> row(int row) const {
        const std::string begin = "t_" + std::to_string(row);
        return {number(begin + "0"), number(begin + "1"), number(begin + "2"), number(begin + "3")};
    }

  private:
    std::string where_;
    std::array<std::optional<double>, names.size()> values_;
};

/// Sets the pose. In the file, the world has y up, and the camera looks along -z with y up. The
/// world of the result has z up.
void set_pose(camera& c, const fields& all, const std::string& where) {
    const std::array<std::array<double, 4>, 3> to_world = {all.row(2), all.row(0), all.row(1)};
    glm::dmat3 axes;
    glm::dvec3 center;
    for (int i = 0; i < 3; ++i) {
        const auto& row = to_world[static_cast<std::size_t>(i)];
        axes[0][i] = row[0];
        axes[1][i] = -row[1];
        axes[2][i] = -row[2];
        center[i] = row[3];
    }
    const auto rotation = nearest_rotation(axes);
    if (!rotation) throw error(where + ": t_00 to t_22 are not a rotation");
    if (!is_valid_position(center)) throw error(where + ": the position t_03, t_13, t_23" + invalid_position);
    c.rotation = glm::transpose(*rotation);
    c.translation = -c.rotation * center;
}

}  // namespace

polycam_camera read_polycam_camera(const std::filesystem::path& file) {
    const std::string where = file.string();
    fields all(where);
    read_json(file, 1, all);
    polycam_camera result;
    camera& c = result.camera;
    c.width = all.side("width");
    c.height = all.side("height");
    c.fx = all.number("fx");
    c.fy = all.number("fy");
    c.cx = all.number("cx");
    c.cy = all.number("cy");
    if (!has_valid_intrinsics(c, {})) throw error(where + invalid_intrinsics);
    set_pose(c, all, where);
    result.blur_score = all.find("blur_score");
    return result;
}

}  // namespace gs
