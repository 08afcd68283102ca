// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "video_file.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "../poses/child_process.hpp"

namespace gs::video {
namespace {

namespace fs = std::filesystem;

/// Returns the arguments for ffmpeg, which reads frames from its input. `file:` keeps it from taking
/// a part of the name for a protocol.
std::vector<std::string> ffmpeg_arguments(const fs::path& file, const format& f) {
    return {"-v",
            "error",
            "-nostats",
            "-y",
            "-f",
            "rawvideo",
            "-pixel_format",
            "rgb24",
            "-video_size",
            std::to_string(f.width) + "x" + std::to_string(f.height),
            "-framerate",
            std::to_string(f.frames_per_second),
            "-i",
            "pipe:0",
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-pix_fmt",
            "yuv420p",
            "-movflags",
            "+faststart",
            "-f",
            "mp4",
            "file:" + file.string()};
}

/// Removes an unfinished file.
class unfinished_file {
  public:
    explicit unfinished_file(fs::path file) : file_(std::move(file)) {}
    unfinished_file(const unfinished_file&) = delete;
    unfinished_file& operator=(const unfinished_file&) = delete;
    ~unfinished_file() {
        std::error_code ignored;
        fs::remove(file_, ignored);
    }
    const fs::path& path() const { return file_; }

  private:
    fs::path file_;
};

}  // namespace

bool is_video(const fs::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    return ending == ".mp4";
}

void require_encoder() {
    if (!poses::is_installed("ffmpeg"))
        throw error(
            "videos need ffmpeg, which is not installed: install it (apt-get install ffmpeg), or give a "
            "folder with -o for PNG files");
}

void write_video(const fs::path& file, const format& format,
                 const std::function<std::vector<std::uint8_t>()>& next) {
    if (fs::is_directory(file))
        throw error("cannot write " + file.string() + ": it is a folder; give another name with -o");
    const unfinished_file part(file.string() + ".part");
    std::string last_line;
    const int status =
        poses::feed_child("ffmpeg", ffmpeg_arguments(part.path(), format), next,
                          [&](const std::string& line) { last_line = sanitize_for_message(line); });
    if (status != 0)
        throw error("ffmpeg cannot write " + file.string() + ": " +
                    (last_line.empty() ? "it ended with status " + std::to_string(status) : last_line));
    fs::rename(part.path(), file);
}

}  // namespace gs::video
