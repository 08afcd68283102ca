// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "../../scene/scene_statistics.hpp"

namespace gs::features {

/// The widths of the sharpest edges of a photo, by the direction across the edge.
struct edge_widths {
    static constexpr std::size_t directions = 12;  ///< in a half circle

    std::array<double, directions> width{};       ///< a low quantile, in pixels; 0 if there are few edges
    std::array<double, directions> error{};       ///< its standard error
    std::array<std::size_t, directions> count{};  ///< number of edges

    static glm::dvec2 direction(std::size_t k);
};

/// Measures the edges of a photo. In large photos, a sample of the rows.
edge_widths measure_edges(const image& photo);

/// The motion blur of a photo, from the widths of its edges relative to those of the other photos.
struct photo_blur {
    bool is_judged = false;   ///< whether it has edges in enough directions
    glm::dvec2 motion{1, 0};  ///< direction and length in pixels; the sign is not known
    double square = 0;        ///< square of the length, not clamped
    double error = 0;         ///< standard error of `square`

    bool is_clear() const;
};

/// The evidence for cameras that move while they take photos.
struct motion_evidence {
    static constexpr std::size_t least_edges = 30;  ///< in a direction that counts
    static constexpr std::size_t least_directions = 8;
    static constexpr double least_blur = 2;      ///< of a blurred photo, in pixels
    static constexpr double least_errors = 6;    ///< its square must exceed these standard errors
    static constexpr double least_share = 0.05;  ///< of the judged photos must be blurred
    static constexpr std::size_t least_blurred = 3, least_photos = 5;

    std::vector<photo_blur> photos;  ///< one per training photo

    std::size_t judged() const;
    std::size_t blurred() const;
    bool is_clear() const;
};

/// Compares the sharpest edges of the photos. A motion widens only the edges across it, as far as the
/// camera moved. An object out of focus widens all of them, and what a scene looks like changes the edges
/// of most photos alike. The width of edges in sharp photos is the resolution of the photos, from any
/// distance.
motion_evidence find_motion_blur(const scene_statistics& statistics);

}  // namespace gs::features
