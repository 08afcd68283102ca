// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "../reader.hpp"

namespace gs {

/// Returns the points that the depth maps of these images show, with the colors of the photos. At
/// most about 100,000 points, spread evenly over the images. Skips images without a depth map, and
/// held-out images. Depths are in millimeters along the axis of the camera. `confidences` may hold
/// a PNG of the same name for each depth map; only its largest values count then. Cost: decodes all
/// photos. Throws `error` with a file that cannot be used.
std::vector<colored_point> points_from_depths(const std::vector<image_record>& images,
                                              const std::filesystem::path& confidences);

}  // namespace gs
