// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "write_colmap_model.hpp"

#include <algorithm>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <ostream>
#include <string_view>
#include <tuple>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../camera_models.hpp"

namespace gs {
namespace {

template <class T>
void put(std::ostream& out, T value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A camera as COLMAP describes it.
struct described_camera {
    std::string_view model;
    int width = 0, height = 0;
    std::vector<double> parameters;

    auto operator<=>(const described_camera&) const = default;
};

described_camera describe(const view& shot) {
    const camera& c = shot.camera_of_file ? *shot.camera_of_file : shot.camera;
    described_camera d{"PINHOLE", c.width, c.height, {c.fx, c.fy, c.cx, c.cy}};
    const auto add = [&](std::string_view model, std::initializer_list<double> coefficients) {
        d.model = model;
        d.parameters.insert(d.parameters.end(), coefficients);
    };
    const lens& l = shot.removed_distortion;
    if (c.fisheye) {
        const auto& [k1, k2, k3, k4] = c.fisheye->k();
        add("OPENCV_FISHEYE", {k1, k2, k3, k4});
    } else if (l.k3 != 0) {
        add("FULL_OPENCV", {l.k1, l.k2, l.p1, l.p2, l.k3, 0, 0, 0});
    } else if (!l.is_none()) {
        add("OPENCV", {l.k1, l.k2, l.p1, l.p2});
    }
    return d;
}

struct posed_image {
    const view* of;
    camera pose;  ///< in internal coordinates
    std::uint32_t camera_id = 0;
};

void put_cameras(std::ostream& out, const std::map<described_camera, std::uint32_t>& cameras) {
    put(out, std::uint64_t{cameras.size()});
    for (const auto& [camera, id] : cameras) {
        put(out, id);
        put(out, std::int32_t{camera_model_named(camera.model, "").id});
        put(out, static_cast<std::uint64_t>(camera.width));
        put(out, static_cast<std::uint64_t>(camera.height));
        for (const double p : camera.parameters) put(out, p);
    }
}

void put_images(std::ostream& out, const std::vector<posed_image>& images, const normalization& world) {
    put(out, std::uint64_t{images.size()});
    for (std::uint32_t i = 0; i < images.size(); ++i) {
        const camera& pose = images[i].pose;
        const glm::dquat q = glm::quat_cast(pose.rotation);
        const glm::dvec3 t = -(pose.rotation * world.to_world(pose.center()));
        put(out, i + 1);
        for (const double value : {q.w, q.x, q.y, q.z, t.x, t.y, t.z}) put(out, value);
        put(out, images[i].camera_id);
        out.write(images[i].of->name.c_str(), static_cast<std::streamsize>(images[i].of->name.size() + 1));
        put(out, std::uint64_t{0});  // observed points
    }
}

void put_points(std::ostream& out, const std::vector<colored_point>& points, const normalization& world) {
    constexpr double unknown_error = -1;
    put(out, std::uint64_t{points.size()});
    for (std::uint64_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 place = world.to_world(points[i].position);
        put(out, i + 1);
        for (const double value : {place.x, place.y, place.z}) put(out, value);
        for (glm::length_t channel = 0; channel < 3; ++channel) put(out, points[i].color[channel]);
        put(out, unknown_error);
        put(out, std::uint64_t{0});  // observations
    }
}

}  // namespace

void require_colmap_cameras(const scene& scene) {
    for (const auto* views : {&scene.train, &scene.test})
        for (const view& shot : *views)
            if (shot.camera.is_panorama)
                throw error("COLMAP has no camera model for panoramas, such as " + shot.name +
                            ": leave out --save-cameras");
}

void write_colmap_model(const std::filesystem::path& folder, const scene& scene,
                        const pose_of_view& learned) {
    std::vector<posed_image> images;
    for (std::size_t v = 0; v < scene.train.size(); ++v) images.push_back({&scene.train[v], learned(v)});
    for (const view& shot : scene.test) images.push_back({&shot, shot.camera});
    std::ranges::sort(images, {}, [](const posed_image& i) -> const std::string& { return i.of->name; });

    std::map<described_camera, std::uint32_t> cameras;
    for (posed_image& i : images)
        i.camera_id =
            cameras.emplace(describe(*i.of), static_cast<std::uint32_t>(cameras.size() + 1)).first->second;

    std::filesystem::create_directories(folder);
    atomic_file_write(folder / "cameras.bin", [&](std::ostream& out) { put_cameras(out, cameras); });
    atomic_file_write(folder / "images.bin",
                      [&](std::ostream& out) { put_images(out, images, scene.normalization); });
    atomic_file_write(folder / "points3D.bin",
                      [&](std::ostream& out) { put_points(out, scene.points, scene.normalization); });
}

}  // namespace gs
