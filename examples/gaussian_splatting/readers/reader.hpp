// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../core/log.hpp"
#include "../scene/scene.hpp"
#include "../scene/undistort.hpp"

namespace gs {

/// The scene to read, and the options of reading it.
struct load_options {
    std::string data;        ///< a path, or a name that a reader knows, such as "synthetic:spheres"
    int resolution = 1;      ///< divisor of the size, or longer side: see `divides_size`
    bool eval = false;       ///< hold out test images; by default, train on all
    bool masks = true;       ///< apply the scene's masks
    bool depths = true;      ///< load the scene's depth maps
    std::uint64_t seed = 0;  ///< for readers that draw random points
    std::uint64_t most_photo_bytes = ~std::uint64_t{0};  ///< larger photos are streamed: see `view`

    // Only some readers use the following options: see `reader_option`.
    std::string images = "images";  ///< the folder of the images, relative to `data`
    int test_every = 8;             ///< hold out every n-th image, sorted by name, from the first
};

/// Returns whether a resolution is a divisor of the images' size; if not, it is their longer side.
constexpr bool divides_size(int resolution) {
    return resolution == 1 || resolution == 2 || resolution == 4 || resolution == 8;
}

/// An option that only some readers use. `load_scene` refuses it for scenes of all other readers.
struct reader_option {
    std::string_view name;                ///< name on the command line
    bool (*is_set)(const load_options&);  ///< returns whether it differs from its default
};
inline constexpr reader_option images_option{
    "--images", [](const load_options& o) { return o.images != load_options().images; }};
inline constexpr reader_option test_every_option{
    "--test-every", [](const load_options& o) { return o.test_every != load_options().test_every; }};

/// One image of a scene. Names files, which `load_scene` loads later, or holds pixels.
struct image_record {
    std::string name;                          ///< unique within the scene; '/' separates folders
    gs::camera camera;                         ///< calibrated for its own size, which is at least 1×1
    bool held_out = false;                     ///< whether it is held out if `load_options::eval` is set
    std::optional<std::uint32_t> rig_frame{};  ///< see `view`

    std::filesystem::path file;   ///< see `read_image`; may be a scaled or rotated copy
    lens distortion;              ///< distortion of the file, which loading removes
    std::string camera_model;     ///< name of the model of `distortion`, for messages
    std::filesystem::path mask;   ///< PNG, see `read_mask`; empty without a mask
    std::filesystem::path depth;  ///< PNG, see `read_depth_map`; empty without a depth map
    depth_values depth_holds = depth_values::inverse_depth;
    int masked_border = 0;  ///< width of the edges to mask, in pixels of `camera`

    image pixels;            ///< instead of `file`: undistorted, at the final resolution
    depth_map depth_pixels;  ///< may accompany `pixels`, and has their size

    bool has_pixels() const { return !pixels.rgba.empty(); }
};

/// A scene before its images are loaded.
struct scene_description {
    std::vector<image_record> images;                ///< in the order of the views
    std::vector<colored_point> points;               ///< may be empty
    bool object_centered = false, rendered = false;  ///< see `scene`
};

/// A kind of scene. To add one, write its folder and add a row to the table in readers.cpp.
struct reader {
    std::string_view name;     ///< in messages, as in "COLMAP scenes"
    std::string_view accepts;  ///< accepted data, such as "a COLMAP folder with sparse"

    /// Returns whether `load_options::data` is such a scene. Looks only at names. The first reader
    /// that returns true reads the scene and reports all its errors.
    bool (*probe)(const std::string& data);

    /// Reads cameras and points. Opens images at most for their size, unless the reader makes the
    /// images. Throws `error` with the file, and the line or record, that is malformed.
    scene_description (*read)(const load_options& options, const log_function& log);

    std::span<const reader_option> options{};  ///< the options that `read` uses
};

/// Returns all readers, in the order in which `load_scene` calls their `probe`.
std::span<const reader* const> all_readers();

/// Returns the scenes that readers accept, for messages: "A, B or C".
std::string accepted_scenes(std::span<const reader* const> readers = all_readers());
/// Returns the names of the readers that use an option, for messages: "A and B".
std::string readers_with(std::string_view option, std::span<const reader* const> readers = all_readers());

}  // namespace gs
