// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "reader.hpp"

namespace gs {

/// The camera of a photo in the size of its image file, and how the stored image must be turned to
/// fit it.
struct fitted_photo {
    camera taken_with;
    orientation turn;
};

/// Scales cameras to the sizes of their image files. Applies the orientation in EXIF data only where
/// the camera has the shape of the upright image: many programs compute cameras from images as they
/// are stored. If the shape fits both ways, as that of a square image, the photo is treated like most
/// photos of the scene whose shapes fit one way only. If there are none, it stays as it is stored.
/// Throws `error` if a camera fits in neither way. Reads the headers of all files.
std::vector<fitted_photo> fit_to_files(const std::vector<image_record>& records, const log_function& log);

}  // namespace gs
