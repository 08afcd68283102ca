// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "../readers/reader.hpp"
#include "stage.hpp"

namespace gs::poses {

/// Computes camera poses with COLMAP for photos or a video, and returns the options to read them.
///
/// `source.data` is a folder of photos, a folder with photos in `source.images`, or a video.
/// The result is the COLMAP scene `output/colmap`, which links to the photos. If that scene comes
/// from the same photos, by names, sizes and times of modification, it is used again. Files are
/// written to `output/colmap.part`, which is renamed when it is complete. `video_frames` is the
/// number of frames to take from a video.
///
/// Throws `error` if the data already has poses, if a program is missing or fails, or if too few
/// photos have poses; then `output/colmap.log` keeps the output of the programs. Throws
/// `interrupted` after Ctrl-C.
load_options compute_poses(const load_options& source, const std::filesystem::path& output,
                           std::optional<int> video_frames, const listener& user);

}  // namespace gs::poses
