// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "reader.hpp"

namespace gs {

/// Loads images from their files, in parallel, and shrinks each at once; the views keep the order of
/// `records`. Cameras are fitted to the size of the files, undistorted, and scaled to the resolution, see
/// `load_options`. Throws `error` naming the file. Precondition: no record holds pixels.
std::vector<view> load_views(const std::vector<image_record>& records, int resolution,
                             const log_function& log);

/// The view with its sides divided by `divisor`, to the nearest pixel: photo and depth map averaged over
/// areas.
view shrunk(const view& full, int divisor);

}  // namespace gs
