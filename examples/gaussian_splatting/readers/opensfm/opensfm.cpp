// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "opensfm.hpp"

#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "../../image/mask.hpp"
#include "../validation.hpp"
#include "opensfm_files.hpp"

namespace gs {
namespace {

/// Returns the path of `reconstruction.json`, or an empty path if it does not exist.
std::filesystem::path find_reconstruction(const std::filesystem::path& data) {
    for (const auto& folder : {data, data / "opensfm"})
        if (auto file = folder / "reconstruction.json"; std::filesystem::exists(file)) return file;
    return {};
}

/// Finds photos in the folder of the photos, or in the list that OpenSfM writes if they lie
/// elsewhere.
class photo_finder {
  public:
    photo_finder(std::filesystem::path photos, std::filesystem::path list)
        : photos_(std::move(photos)), list_(std::move(list)) {
        std::ifstream in(list_);
        for (std::string line; std::getline(in, line);) {
            if (!line.empty() && line.back() == '\r') line.pop_back();
            const std::filesystem::path file = list_.parent_path() / line;
            if (line.size() <= longest_path) listed_[file.filename().string()] = file;
        }
    }

    std::filesystem::path find(const std::string& name) const {
        if (auto file = photos_ / name; std::filesystem::is_regular_file(file)) return file;
        const auto listed = listed_.find(name);
        if (listed != listed_.end() && std::filesystem::is_regular_file(listed->second))
            return listed->second;
        throw error("the photo " + sanitize_for_message(name) + " is neither in " + photos_.string() +
                    " nor at a path in " + list_.string());
    }

  private:
    std::filesystem::path photos_, list_;
    std::map<std::string, std::filesystem::path> listed_;
};

glm::dmat3 rotation_matrix(const glm::dvec3& axis_times_angle) {
    const double angle = glm::length(axis_times_angle);
    if (angle == 0) return glm::dmat3(1);
    return glm::mat3_cast(glm::angleAxis(angle, axis_times_angle / angle));
}

image_record record_of(const opensfm_shot& shot, const opensfm_camera& taken_with) {
    image_record one;
    one.name = shot.name;
    one.camera = taken_with.camera();
    one.camera.rotation = rotation_matrix(shot.rotation);
    one.camera.translation = shot.translation;
    one.distortion = taken_with.distortion();
    one.camera_model = taken_with.projection->name;
    return one;
}

scene_description describe(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data, file = find_reconstruction(data);
    const auto [found, count] = read_opensfm_reconstructions(file);
    if (count > 1)
        log(file.string() + " has " + std::to_string(count) + " reconstructions; the largest, with " +
            std::to_string(found.shots.size()) + " photos, is used");
    const photo_finder photos(data / options.images, file.parent_path() / "image_list.txt");
    scene_description result;
    for (const opensfm_shot& shot : found.shots) {
        image_record one = record_of(shot, *found.find_camera(shot));
        one.file = photos.find(shot.name);
        if (options.masks) one.mask = beside_photo(data / "masks", one.name);
        if (options.depths) one.depth = beside_photo(data / "depths", one.name);
        result.images.push_back(std::move(one));
    }
    hold_out_views(result.images, options);
    result.points.assign(found.points.begin(), found.points.end());
    if (result.points.empty()) log("the OpenSfM reconstruction has no points");
    return result;
}

constexpr reader_option used_options[] = {images_option, test_every_option};

}  // namespace

constinit const reader opensfm_reader{
    "OpenSfM", "an OpenSfM or ODM folder with reconstruction.json",
    [](const std::string& data) { return !find_reconstruction(data).empty(); }, describe, used_options};

}  // namespace gs
