// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "../camera_models.hpp"
#include "../reader.hpp"

namespace gs {

struct colmap_camera {
    std::uint32_t id = 0;
    int width = 0, height = 0;
    int model_id = 0;  ///< see `camera_model`
    double fx = 0, fy = 0, cx = 0, cy = 0;
    std::array<double, 4> coefficients{};  ///< k1 k2 p1 p2 of `lens`, or k1 to k4 of `fisheye`
    double k3 = 0;                         ///< of `lens`

    const camera_model& model() const { return camera_model_with_id(model_id, {}); }
    /// Returns the camera at the origin, without distortion.
    gs::camera camera() const {
        gs::camera c{width, height, fx, fy, cx, cy};
        if (model().is_fisheye) c.fisheye = fisheye(coefficients);
        return c;
    }

    lens distortion() const {
        const auto& [k1, k2, p1, p2] = coefficients;
        return model().is_fisheye ? lens{} : lens{k1, k2, p1, p2, k3};
    }
};

struct colmap_image {
    std::uint32_t id = 0, camera_id = 0;
    std::size_t name_begins = 0;  ///< position of the name in `colmap_model::names`
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 translation{0};
};

/// An image, and the frame to which it belongs. A frame has the images that the cameras of a rig took at
/// once.
struct colmap_frame_image {
    std::uint64_t image_id = 0;
    std::uint32_t frame_id = 0;
};

struct colmap_model {
    std::vector<colmap_camera> cameras;  ///< sorted by id
    std::vector<colmap_image> images;    ///< in the file's order
    std::vector<colored_point> points;
    std::vector<colmap_frame_image> frames;  ///< sorted by image; empty before COLMAP 3.12
    std::string names;                       ///< names of the images, each with a terminating zero
    std::filesystem::path images_file;       ///< the file with the images, for messages

    const char* name(const colmap_image& image) const { return names.c_str() + image.name_begins; }
};

/// Reads cameras, images, points3D and frames from a folder. Each file is a `.bin`, or a `.txt` if the
/// `.bin` does not exist. The points and the frames may be missing. Throws `error` with the file, and the
/// line or record, that is malformed. Allocates at most four times the size of the files plus 64 KiB, also
/// for malformed files.
colmap_model read_colmap_model(const std::filesystem::path& folder);

/// Reads a folder with a COLMAP model in sparse/0 or sparse, with images, and possibly with masks
/// and depth maps. The images are sorted by name. Every `test_every`-th image is held out.
extern const reader colmap_reader;

}  // namespace gs
