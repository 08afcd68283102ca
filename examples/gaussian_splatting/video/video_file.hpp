// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gs::video {

/// Returns whether a path names a video: whether it ends with ".mp4", in upper or lower case.
bool is_video(const std::filesystem::path& path);

/// Throws `error` with the remedy if ffmpeg, which encodes videos, is not installed.
void require_encoder();

struct format {
    int width = 0, height = 0;  ///< even
    int frames_per_second = 30;
};

/// Writes a video (H.264 in MP4) as a whole or not at all. `next` returns the next frame, 8-bit RGB
/// row by row from the top, or nothing at the end. Runs ffmpeg. Throws `error` if it fails, and
/// `poses::interrupted` after Ctrl-C.
void write_video(const std::filesystem::path& file, const format& format,
                 const std::function<std::vector<std::uint8_t>()>& next);

}  // namespace gs::video
