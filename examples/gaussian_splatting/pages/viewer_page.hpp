// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "../scene/camera.hpp"

namespace gs::pages {

/// What the viewer knows about a scene besides its Gaussians, in world coordinates.
struct viewer_scene {
    std::string title = "Scene";
    std::vector<camera> views;  ///< the first one is shown first; not empty. Lenses are ignored.
    glm::dvec3 up{0, -1, 0};    ///< unit vector
    glm::dvec3 pivot{0};        ///< point around which the camera turns
    double radius = 1;          ///< distance of the pivot for views that look away from `pivot`
    double near_plane = 0;      ///< Gaussians at this depth or nearer are not drawn
    std::array<float, 3> background{};
    bool antialiased = false;
    std::vector<float> sky;     ///< see `gaussians::sky`
    std::size_t gaussians = 0;  ///< their number before decimation
};

/// Writes a page that shows Gaussians in a browser, without other files and without a network.
/// `write_splat` writes a compressed .ply file; only a part of it is in memory.
void write_viewer_page(std::ostream& out, const viewer_scene& scene,
                       const std::function<void(std::ostream&)>& write_splat);

/// Returns the size of the page for a splat of this size, both in bytes.
std::uint64_t viewer_page_size(const viewer_scene& scene, std::uint64_t splat_bytes);

}  // namespace gs::pages
