// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gs {

/// Returns whether the name ends like that of a photo: see `image_endings`.
bool is_photo_name(const std::filesystem::path& file);
/// Returns whether the path is a file whose name ends like that of a video.
bool is_video_file(const std::filesystem::path& file);

/// Returns the photos in a folder and its subfolders, sorted: names relative to the folder, with
/// '/' between folders. Skips hidden files, the folders `masks` and `depths`, the folder
/// `excluded`, and folders with results of training. Does not follow links to folders. Throws
/// `error` for a folder with more than a million entries.
std::vector<std::string> photo_names(const std::filesystem::path& folder,
                                     const std::filesystem::path& excluded = {});

/// Returns a message for a scene without a reader that consists of photos or a video, and
/// otherwise an empty text.
std::string missing_poses_message(const std::string& data);

}  // namespace gs
