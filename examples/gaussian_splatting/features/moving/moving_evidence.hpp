// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "../../scene/scene_statistics.hpp"

namespace gs::features {

/// The points that something hides in one photo, although the other photos show them.
struct hidden_points {
    std::size_t compared = 0;  ///< number of points whose color in this photo is predicted
    std::vector<observation> hidden;

    double share() const { return compared > 0 ? double(hidden.size()) / double(compared) : 0; }
};

/// The evidence for things that move while photos are taken.
struct moving_evidence {
    /// A photo shows a moving thing if it hides this many points, and this share of the compared ones.
    static constexpr std::size_t least_hidden = 8;
    static constexpr double least_share = 0.08;

    std::size_t points = 0;             ///< number of points whose color is predicted
    std::vector<hidden_points> photos;  ///< one per training photo

    /// Returns the number of photos that show a moving thing.
    std::size_t count() const;
    /// Returns whether two photos show a moving thing. In a single photo, the exposure or the pose may be
    /// wrong.
    bool is_clear() const { return count() >= 2; }
    /// Returns the number of hidden points in all photos in which something hides `least_share`. Eight are
    /// clear evidence if points are parts of a model, which explains other differences.
    std::size_t hidden_in_large_shares() const;
    /// Returns for each photo whether it has a part in clear evidence. The evidence for other effects leaves
    /// out such photos, because hidden points would pass for another effect.
    std::vector<bool> contributing_photos() const;
};

/// Compares the color of each point in a photo with its median color over all photos in which it has a
/// similar size, after differences of exposure are removed. A point is hidden if
///
/// - its color differs much more than in most photos,
/// - it looks as usual in the photos with the most similar viewing directions; otherwise it may be glossy,
///   or a static object may hide it,
/// - and the same holds for almost all points around it in this photo. Errors of poses, gloss, noise and
///   objects with points of their own change some points among others that look as usual.
///
/// A photo in which most points differ does not count: its pose or its exposure is wrong. Cost: for each
/// hidden point, one pass over the points in its photo.
moving_evidence find_moving_things(const scene_statistics& statistics);
/// Compares observations of equal size in `photos` photos. Points that too few photos show do not count.
moving_evidence find_moving_things(observed_points points, std::size_t photos);

}  // namespace gs::features
