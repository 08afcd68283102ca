// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "depth_map.hpp"
#include "image.hpp"

namespace gs {

/// The PNG in `folder` that belongs to a photo, such as its mask or depth map: `NAME.png`, as
/// COLMAP names masks, or the photo's name with the ending `.png`. Empty if neither exists inside
/// the folder.
std::filesystem::path beside_photo(const std::filesystem::path& folder, const std::string& photo);

/// Reads a mask, scaled to the size of its photo: black pixels exclude the photo's pixels, and all
/// others become white. Throws `error` as `read_image` does, and if the mask is smaller than the
/// photo or has another aspect ratio.
image read_mask(const std::filesystem::path& file, const image& photo);

/// Masks the pixels of the photo at which the mask is darker than half. Precondition: equal sizes.
void apply_mask(const image& mask, image& photo);

/// Marks depths as unknown at masked pixels of the photo. Precondition: equal sizes, or an empty
/// depth map.
void clear_masked_depths(const image& photo, depth_map& depths);

}  // namespace gs
