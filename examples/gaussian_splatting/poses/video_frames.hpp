// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "stage.hpp"

namespace gs::poses {

/// The numbers of frames that can be taken from a video.
inline constexpr int default_video_frames = 150, least_video_frames = 5, most_video_frames = 1000;

/// Returns the variance of the Laplacian, which is low for blurred images. `gray`: width * height
/// pixels, row by row. Precondition: width and height are at least 3.
double sharpness(std::span<const std::uint8_t> gray, int width, int height);

/// Divides [0, values.size()) into at most `count` windows of almost equal length, and returns the
/// index of the largest value of each.
std::vector<std::size_t> largest_of_each_window(const std::vector<double>& values, std::size_t count);

/// Writes about `count` frames of a video as JPEG files into the folder `frames`, which must not
/// exist: the sharpest of each part of the video. Runs ffprobe and ffmpeg. Throws `error` if they
/// fail, and `interrupted` after Ctrl-C. Decodes the video twice.
void extract_frames(const std::filesystem::path& video, int count, const std::filesystem::path& frames,
                    stage_runner& runner, const listener& user);

}  // namespace gs::poses
