// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "../scene/scene.hpp"

namespace gs::train {

/// Where the first Gaussians come from.
enum class point_source {
    automatic,  ///< the points of the scene; of photos with fewer than `enough_points`, also those of stereo
    given,      ///< the points of the scene
    stereo,     ///< see `stereo::dense_points`
    random      ///< see `random_points`
};
constexpr std::array<std::string_view, 4> names_of(point_source) {
    return {"auto", "given", "stereo", "random"};
}

/// The number of points up to which stereo adds points. More of them do not improve results, because
/// densification adds Gaussians where photos call for them.
inline constexpr std::size_t enough_points = 15000;

struct first_points {
    std::vector<colored_point> points;
    std::string remark;  ///< one sentence for the user if they are not just the points of the scene
};

/// Returns the points for the first Gaussians, at most about half of `most` random ones. Automatic choice
/// takes random points if the scene has none and stereo finds hardly any, and for rendered scenes without
/// points. Throws `error` if the source has no points. Cost: see the source.
first_points find_first_points(const scene& of, point_source source, std::size_t most, std::uint64_t seed);

}  // namespace gs::train
