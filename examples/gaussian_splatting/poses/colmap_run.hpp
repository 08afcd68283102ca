// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
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

/// Returns whether each photo is matched with all others. Videos and large sets take too long.
bool matches_exhaustively(const photo_set& photos);

/// Returns the pairs of photos to match, as indices, if not all are: each photo with its
/// neighbors in the order of names, and about 60 evenly spaced photos with each other, which
/// connects the end of a walk to its beginning.
std::set<std::pair<std::size_t, std::size_t>> pairs_to_match(std::size_t photos);

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
