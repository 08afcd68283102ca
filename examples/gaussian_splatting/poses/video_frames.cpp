// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "video_frames.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>

#include "../core/error.hpp"

namespace gs::poses {
namespace {

namespace fs = std::filesystem;

/// Candidates are compared at this size, in gray. It keeps the blur of moving cameras visible.
constexpr int gray_width = 480, gray_height = 360;
constexpr std::size_t gray_bytes = std::size_t{gray_width} * gray_height;
constexpr int candidates_per_frame = 5;

/// Names a file such that ffmpeg does not take a part of the name for a protocol.
std::string file_argument(const fs::path& file) { return "file:" + file.string(); }

/// Returns the path for ffmpeg's numbering of files, in which '%' begins a number.
std::string numbered(const fs::path& folder) {
    std::string escaped;
    for (const char c : folder.string()) escaped += c == '%' ? "%%" : std::string(1, c);
    return escaped + "/frame_%05d.jpg";
}

/// ffmpeg reports its progress in lines like "frame=12".
int frames_done(const std::string& line) {
    int frames = 0;
    return std::sscanf(line.c_str(), "frame=%d", &frames) == 1 ? frames : -1;
}

/// Returns the number of frames, which the packets of the video stream tell without decoding.
int count_frames(const fs::path& video, stage_runner& runner) {
    int frames = 0;
    runner.require(
        {.name = "reading the video",
         .program = "ffprobe",
         .arguments = {"-v", "error", "-select_streams", "v:0", "-count_packets", "-show_entries",
                       "stream=nb_read_packets", "-of", "default=noprint_wrappers=1", file_argument(video)},
         .total = 1,
         .parts_done = [&](const std::string& line) {
             std::sscanf(line.c_str(), "nb_read_packets=%9d", &frames);
             return -1;
         }});
    if (frames < 1) throw error(video.string() + " has no video frames");
    return frames;
}

stage ffmpeg_stage(const std::string& name, const fs::path& video, const std::string& filters, int total) {
    return {.name = name,
            .program = "ffmpeg",
            .arguments = {"-nostdin", "-v", "error", "-nostats", "-progress", "pipe:1", "-i",
                          file_argument(video), "-map", "0:v:0", "-vf", filters, "-fps_mode", "passthrough"},
            .total = total,
            .parts_done = frames_done};
}

/// Returns the sharpness of every `step`-th frame.
std::vector<double> measure_candidates(const fs::path& video, int step, int total, const fs::path& temporary,
                                       stage_runner& runner) {
    const std::string filters = "select=not(mod(n\\," + std::to_string(step) +
                                ")),scale=" + std::to_string(gray_width) + ":" + std::to_string(gray_height) +
                                ",format=gray";
    stage one = ffmpeg_stage("sharpness of frames", video, filters, total);
    for (const std::string& argument : {std::string("-f"), std::string("rawvideo"), file_argument(temporary)})
        one.arguments.push_back(argument);
    runner.require(one);
    std::ifstream in(temporary, std::ios::binary);
    std::vector<std::uint8_t> gray(gray_bytes);
    std::vector<double> measured;
    while (in.read(reinterpret_cast<char*>(gray.data()), gray_bytes))
        measured.push_back(sharpness(gray, gray_width, gray_height));
    fs::remove(temporary);
    if (measured.empty()) throw error(video.string() + " has no video frames that ffmpeg can decode");
    return measured;
}

void write_frames(const fs::path& video, const std::vector<std::size_t>& indices, int step,
                  const fs::path& frames, stage_runner& runner) {
    std::string chosen;
    for (const std::size_t index : indices)
        chosen += (chosen.empty() ? "" : "+") + std::string("eq(n\\,") +
                  std::to_string(index * static_cast<std::size_t>(step)) + ")";
    stage one = ffmpeg_stage("writing frames", video, "select=" + chosen, static_cast<int>(indices.size()));
    for (const std::string& argument : {std::string("-q:v"), std::string("2"), numbered(frames)})
        one.arguments.push_back(argument);
    fs::create_directory(frames);
    runner.require(one);
}

}  // namespace

double sharpness(std::span<const std::uint8_t> gray, int width, int height) {
    double sum = 0, squares = 0;
    const auto row = static_cast<std::size_t>(width);
    for (std::size_t y = 1; y + 1 < static_cast<std::size_t>(height); ++y)
        for (std::size_t i = y * row + 1; i < y * row + row - 1; ++i) {
            const double laplacian =
                4.0 * gray[i] - gray[i - 1] - gray[i + 1] - gray[i - row] - gray[i + row];
            sum += laplacian;
            squares += laplacian * laplacian;
        }
    const double count = (width - 2.0) * (height - 2.0);
    return squares / count - (sum / count) * (sum / count);
}

std::vector<std::size_t> largest_of_each_window(const std::vector<double>& values, std::size_t count) {
    const std::size_t windows = std::min(count, values.size());
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < windows; ++i) {
        const auto at = [&](std::size_t window) {
            return values.begin() + static_cast<std::ptrdiff_t>(window * values.size() / windows);
        };
        chosen.push_back(static_cast<std::size_t>(std::max_element(at(i), at(i + 1)) - values.begin()));
    }
    return chosen;
}

void extract_frames(const fs::path& video, int count, const fs::path& frames, stage_runner& runner,
                    const listener& user) {
    const stopwatch watch;
    const int available = count_frames(video, runner);
    const int step = std::max(1, available / (count * candidates_per_frame));
    const auto measured =
        measure_candidates(video, step, (available + step - 1) / step, frames.string() + ".gray", runner);
    const auto chosen = largest_of_each_window(measured, static_cast<std::size_t>(count));
    write_frames(video, chosen, step, frames, runner);
    user.say("the sharpest " + std::to_string(chosen.size()) + " of " + std::to_string(available) +
             " video frames: " + watch.text());
}

}  // namespace gs::poses
