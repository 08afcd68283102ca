// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "depth_map.hpp"
#include "image.hpp"

namespace gs {

/// Returns the PNG in `folder` that belongs to a photo, such as its mask or depth map. Its name is
/// `NAME.png`, as COLMAP names masks, or the photo's name with the ending `.png`. Returns an empty
/// path if neither file exists, or if the photo's name leads out of the folder.
std::filesystem::path beside_photo(const std::filesystem::path& folder, const std::string& photo);

/// Reads a mask and scales it to the size of its photo. Black pixels exclude the photo's pixels;
/// all other colors become white. Throws `error` like `read_image`, and if the mask is smaller than
/// the photo or has another aspect ratio.
image read_mask(const std::filesystem::path& file, const image& photo);

/// Masks the pixels of the photo where the mask is darker than half. Precondition: equal sizes.
void apply_mask(const image& mask, image& photo);

/// Masks the pixels of the photo that are less than `width` pixels from an edge.
void mask_border(int width, image& photo);

/// Marks depths as unknown at masked pixels of the photo. Precondition: equal sizes, or an empty
/// depth map.
void clear_masked_depths(const image& photo, depth_map& depths);

}  // namespace gs
