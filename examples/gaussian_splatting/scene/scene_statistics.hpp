// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "photo_brightness.hpp"
#include "scene.hpp"

namespace gs {

/// What several features look at in the photos of a scene. Each part is computed on first use and kept.
class scene_statistics {
  public:
    /// Fewer observations of a point say nothing about it.
    static constexpr std::size_t least_photos_of_point = 5;

    explicit scene_statistics(const scene& of) : scene_(of) {}

    const gs::scene& scene() const { return scene_; }
    /// The observations of each point; see `observe_points`.
    const observed_points& points() const;
    /// Those in smooth parts of the photos, of points that keep enough of them: where the photo is rough, a
    /// point's color depends on where exactly it is. The smoothest tenth tells what is noise.
    const observed_points& smooth_points() const;
    /// Empty lists if there are no smooth points.
    const photo_brightness& brightness() const;

  private:
    const gs::scene& scene_;
    mutable std::optional<observed_points> points_, smooth_;
    mutable std::optional<photo_brightness> brightness_;
};

}  // namespace gs
