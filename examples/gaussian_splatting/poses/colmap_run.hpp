// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stage.hpp"

namespace gs::poses {

/// The photos whose cameras COLMAP computes.
struct photo_set {
    std::filesystem::path folder;
    std::vector<std::string> names;  ///< relative to the folder, sorted
    bool are_frames = false;         ///< whether they are the frames of a video, in order
};

/// Fewer photos or poses than this make no scene.
inline constexpr std::size_t fewest_photos = 5;

/// How to find the pairs of photos that show the same things.
enum class matching { exhaustive, sequential };

/// Returns `sequential` for videos and for sets that are too large to match each photo with all
/// others.
matching matching_for(const photo_set& photos);

/// Groups photos by their size, because photos of one camera share one set of intrinsics. Opens
/// each file for its size.
std::vector<std::vector<std::string>> groups_of_equal_size(const photo_set& photos);

/// Runs COLMAP's feature extraction, matching and mapper, and puts `database.db` and the largest
/// model, as `sparse/0`, into the folder `result`. Throws `error` if COLMAP fails, or finds the
/// poses of fewer than `fewest_photos` photos, and `interrupted` after Ctrl-C. Duration: seconds
/// per photo, and a fraction of a second per pair of photos.
void run_colmap(const photo_set& photos, const std::filesystem::path& result, stage_runner& runner,
                const listener& user);

}  // namespace gs::poses
