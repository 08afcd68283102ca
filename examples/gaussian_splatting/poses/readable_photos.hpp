// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "colmap_run.hpp"

namespace gs::poses {

/// Returns whether COLMAP can read all photos of the set, judged by the endings of their names.
bool is_readable_by_colmap(const photo_set& photos);

/// Writes all photos to a folder: copies those that COLMAP can read, and converts the others, such as
/// HEIC files, to upright PNG files. "a/b.heic" becomes "a/b.heic.png". Returns the new set. Throws
/// `error` if a photo cannot be read or written. Duration: a few seconds per converted photo and core.
photo_set make_readable(const photo_set& photos, const std::filesystem::path& folder, const listener& user);

}  // namespace gs::poses
