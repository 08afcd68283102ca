// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "image.hpp"

namespace gs {

/// The file that says which pixels of a photo count, a PNG in this folder: `NAME.png`, as COLMAP names masks,
/// or the photo's name with `.png` in place of its ending. Empty if neither is there, or not in the folder.
std::filesystem::path mask_of(const std::filesystem::path& folder, const std::string& photo);

/// A mask, black where it leaves out and else white: what is black in the file, as COLMAP has it, or mostly
/// so where it is larger than its photo. Errors as `read_image`, and where it is smaller or of another shape.
image read_mask(const std::filesystem::path& file, const image& photo);

/// Leaves out of the photo where the mask, which has its size, is darker than half.
void apply_mask(const image& mask, image& photo);

}  // namespace gs
