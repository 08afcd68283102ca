// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "opensfm_files.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "../../core/enumerated.hpp"
#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../json_events.hpp"
#include "../validation.hpp"
#include "opensfm_record.hpp"

namespace gs {
namespace {

constexpr opensfm_projection projections[] = {
    {"perspective", false},
    {"simple_radial", true},
    {"radial", true},
    {"brown", true},
    {"fisheye", false, lens_model::fisheye},
    {"fisheye_opencv", true, lens_model::fisheye},
    {"spherical", false, lens_model::panorama},
    {"equirectangular", false, lens_model::panorama},
};

const opensfm_projection& projection_called(const std::string& name, const std::string& where) {
    const auto found = std::ranges::find(projections, name, &opensfm_projection::name);
    if (found != std::end(projections)) return *found;
    std::vector<std::string_view> names;
    for (const opensfm_projection& one : projections) names.push_back(one.name);
    throw error(where + ": the projection_type " + sanitize_for_message(name) +
                " is unknown; supported are " + enumerated(names, " and "));
}

opensfm_camera camera_from(const opensfm_record& record, const std::string& id) {
    opensfm_camera c;
    c.id = id;
    c.projection = &projection_called(record.text("projection_type"), record.where());
    c.width = record.side("width");
    c.height = record.side("height");
    if (c.projection->lens == lens_model::panorama) {
        panorama_of_size(c.width, c.height, record.where());
        return c;
    }
    const bool two = c.projection->two_focal_lengths;
    c.focal_x = record.number(two ? "focal_x" : "focal");
    c.focal_y = record.number(two ? "focal_y" : "focal");
    c.c_x = record.number_or_zero("c_x");
    c.c_y = record.number_or_zero("c_y");
    c.k = {record.number_or_zero("k1"), record.number_or_zero("k2"), record.number_or_zero("k3"),
           record.number_or_zero("k4")};
    c.p1 = record.number_or_zero("p1");
    c.p2 = record.number_or_zero("p2");
    if (!has_valid_intrinsics(c.camera(), c.distortion())) throw error(record.where() + invalid_intrinsics);
    return c;
}

opensfm_shot shot_from(const opensfm_record& record, const std::string& name) {
    opensfm_shot shot{name, record.text("camera"), record.vector("rotation"), record.vector("translation")};
    if (!is_valid_position(shot.translation))
        throw error(record.where() + ": the translation" + invalid_position);
    constexpr double largest_angle = 1e6;
    if (!(glm::dot(shot.rotation, shot.rotation) <= largest_angle * largest_angle))
        throw error(record.where() + ": the rotation is larger than 1e6");
    return shot;
}

colored_point point_from(const opensfm_record& record) {
    colored_point point;
    point.position = record.vector("coordinates");
    if (!is_valid_position(point.position)) throw error(record.where() + ": the position" + invalid_position);
    const glm::dvec3 color = record.vector("color");
    for (int channel = 0; channel < 3; ++channel)
        point.color[channel] = static_cast<std::uint8_t>(std::lround(std::clamp(color[channel], 0.0, 255.0)));
    return point;
}

template <class T>
void sort_unique(std::deque<T>& records, std::string T::*key, const std::string& where) {
    std::ranges::sort(records, {}, key);
    const auto twice = std::ranges::adjacent_find(records, {}, key);
    if (twice != records.end()) throw error(where + " has " + sanitize_for_message((*twice).*key) + " twice");
}

/// Collects reconstructions while the parser reads the file. The number of steps to a value tells
/// its level: reconstruction (1), section (2), record (3), field (4), component of a vector (5).
class collector final : public json_events {
  public:
    static constexpr std::size_t deepest = 5;

    collector(opensfm_reconstructions& into, std::string file) : all_(into), file_(std::move(file)) {}

    void begin(const json_path& path, bool is_object) override {
        if (path.empty() && is_object) throw error(file_ + " is not a JSON array of reconstructions");
        if (path.size() == 1) {
            if (!is_object) refuse(path);
            current_ = {};
        }
        if (!is_used(path)) return;
        if (path.size() <= 3 && !is_object) refuse(path);
        if (path.size() == 3) record_.begin(where(path));
        if (path.size() == 4 && is_object) record_.set(path[3].key, {});
        if (path.size() == 4 && !is_object) record_.begin_vector(path[3].key);
    }

    void value(const json_path& path, const json_value& one) override {
        if (path.empty()) throw error(file_ + " is not a JSON array of reconstructions");
        if (path.size() == 1 || (is_used(path) && path.size() <= 3)) refuse(path);
        if (!is_used(path)) return;
        if (path.size() == 4) record_.set(path[3].key, one);
        if (path.size() == 5) record_.add_component(path[3].key, one.number);
    }

    void end(const json_path& path) override {
        if (path.size() == 1) finish_reconstruction(path);
        if (!is_used(path) || path.size() != 3) return;
        const std::string &section = path[1].key, &name = path[2].key;
        if (section == "cameras") current_.cameras.push_back(camera_from(record_, name));
        if (section == "shots") current_.shots.push_back(shot_from(record_, name));
        if (section == "points") current_.points.push_back(point_from(record_));
    }

  private:
    static bool is_used(const json_path& path) {
        if (path.size() < 2) return false;
        const std::string& section = path[1].key;
        return section == "cameras" || section == "shots" || section == "points";
    }

    std::string where(const json_path& path) const {
        std::string text = file_ + ": reconstruction " + std::to_string(path[0].index);
        if (path.size() == 2) text += ", " + path[1].key;
        if (path.size() > 2)  // the name of the section without its "s"
            text += ", " + path[1].key.substr(0, path[1].key.size() - 1) + " " +
                    sanitize_for_message(path[2].key);
        return text;
    }

    [[noreturn]] void refuse(const json_path& path) const {
        throw error(where(path) + " is not a JSON object");
    }

    void finish_reconstruction(const json_path& path) {
        const std::string name = where(path);
        sort_unique(current_.cameras, &opensfm_camera::id, name);
        sort_unique(current_.shots, &opensfm_shot::name, name);
        for (const opensfm_shot& shot : current_.shots)
            if (!current_.find_camera(shot))
                throw error(name + ", shot " + sanitize_for_message(shot.name) + ": the camera " +
                            sanitize_for_message(shot.camera_id) + " does not exist");
        if (all_.count++ == 0 || current_.shots.size() > all_.largest.shots.size())
            all_.largest = std::move(current_);
    }

    opensfm_reconstructions& all_;
    std::string file_;
    opensfm_reconstruction current_;
    opensfm_record record_;
};

}  // namespace

camera opensfm_camera::camera() const {
    if (projection->lens == lens_model::panorama) return gs::camera::panorama(width, height);
    const double longer = std::max(width, height);
    gs::camera c{width,
                 height,
                 longer * focal_x,
                 longer * focal_y,
                 longer * c_x + 0.5 * width,
                 longer * c_y + 0.5 * height};
    if (projection->lens == lens_model::fisheye) c.fisheye = fisheye(k);
    return c;
}

lens opensfm_camera::distortion() const {
    return projection->lens == lens_model::pinhole ? lens{k[0], k[1], p1, p2, k[2]} : lens{};
}

const opensfm_camera* opensfm_reconstruction::find_camera(const opensfm_shot& shot) const {
    const auto found = std::ranges::lower_bound(cameras, shot.camera_id, {}, &opensfm_camera::id);
    return found != cameras.end() && found->id == shot.camera_id ? &*found : nullptr;
}

opensfm_reconstructions read_opensfm_reconstructions(const std::filesystem::path& file) {
    opensfm_reconstructions result;
    collector all(result, file.string());
    read_json(file, collector::deepest, all);
    if (result.largest.shots.empty()) throw error(file.string() + " has no shots");
    return result;
}

}  // namespace gs
