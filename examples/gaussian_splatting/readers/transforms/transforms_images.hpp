// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "../reader.hpp"
#include "transforms.hpp"

namespace gs {

/// Returns the images of a transforms file of the scene in the folder `data`. Throws `error` with
/// the frame that has invalid intrinsics, or names a file that does not exist.
std::vector<image_record> image_records(const std::filesystem::path& data, const transforms& all,
                                        const load_options& options);

/// Returns the points of `ply_file_path`, or none if the file does not name any. They have the
/// coordinates of `transform_matrix`: nerfstudio applies `applied_transform` to both.
std::vector<colored_point> points_of(const std::filesystem::path& data, const transforms& all);

}  // namespace gs
