// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "scene.hpp"

namespace gs {

/// The shift of a photo against the points of its scene.
struct photo_shift {
    bool is_judged = false;  ///< whether two halves of the points agree about the shift
    glm::dvec2 pixels{0};
};

/// How far photos are shifted. If poses are not exact, points do not lie where photos show their colors.
struct photo_shifts {
    static constexpr std::size_t least_points = 60;  ///< of a photo that is judged
    static constexpr std::size_t least_photos = 5;   ///< that are judged
    static constexpr double least_share = 1.0 / 3;   ///< of the examined photos that are judged
    static constexpr double least_shift = 1;         ///< of the median photo, in pixels

    std::vector<photo_shift> photos;  ///< one per training photo
    std::size_t examined = 0;         ///< number of photos in the sample that was compared

    std::size_t judged() const;
    /// Returns whether enough photos are judged. The halves of a photo may agree by chance.
    bool are_decided() const {
        return judged() >= least_photos &&
               static_cast<double>(judged()) >= least_share * static_cast<double>(examined);
    }
    /// Returns the length of the shift of the median photo that is judged, in pixels.
    double median_shift() const;
    bool are_clear() const { return are_decided() && median_shift() >= least_shift; }
};

/// Measures the shift of a photo: the one for which the brightness of the points and that of the photo at
/// their places most likely depend on each other, by their correlation. Exposure does not matter. Cost: up to
/// ten milliseconds.
photo_shift measure_shift(const std::vector<colored_point>& points, const camera& c, const image& photo);

/// Measures how far photos are shifted: see `measure_shift`. A small error of a camera's rotation shifts its
/// whole photo; one of its position does so for points at about one distance. Examines at most `most_photos`.
/// Cost: decodes these, and takes up to ten milliseconds for each.
photo_shifts measure_shifts(const scene& of, std::size_t most_photos);

}  // namespace gs
