// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "depth_map.hpp"
#include "image.hpp"

namespace gs {

/// What a folder has of a photo, its mask or its depth map, a PNG: `NAME.png`, as COLMAP names masks, or the
/// photo's name with `.png` in place of its ending. Empty if neither is there, or not in the folder.
std::filesystem::path beside_photo(const std::filesystem::path& folder, const std::string& photo);

/// A mask, black where it leaves out and else white: what is black in the file, as COLMAP has it, or mostly
/// so where it is larger than its photo. Errors as `read_image`, and where it is smaller or of another shape.
image read_mask(const std::filesystem::path& file, const image& photo);

/// Leaves out of the photo where the mask, which has its size, is darker than half.
void apply_mask(const image& mask, image& photo);

/// Depths are not known where a photo, which has the map's size, is left out; nor is anything without a map.
void forget_left_out(const image& photo, depth_map& depths);

}  // namespace gs
