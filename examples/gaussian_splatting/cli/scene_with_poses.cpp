// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "scene_with_poses.hpp"

#include <unistd.h>

#include <cstdio>

#include "../poses/child_process.hpp"
#include "../poses/compute_poses.hpp"
#include "command_context.hpp"
#include "stop_signals.hpp"

namespace gs::cli {

namespace {

/// Shows the running stage in one line of a terminal, and nothing elsewhere.
class stage_line {
  public:
    explicit stage_line(bool quiet) : shown_(!quiet && isatty(STDOUT_FILENO) != 0) {}
    stage_line(const stage_line&) = delete;
    stage_line& operator=(const stage_line&) = delete;
    ~stage_line() { clear(); }

    void show(const std::string& stage, int done, int total) {
        if (!shown_) return;
        if (stage != stage_) watch_ = stopwatch();
        stage_ = stage;
        std::printf("\r\x1b[K%s: %d of %d%s", stage.c_str(), done, total, time_left(done, total).c_str());
        std::fflush(stdout);
    }
    void clear() const {
        if (shown_) std::printf("\r\x1b[K");
    }

  private:
    std::string time_left(int done, int total) const {
        if (done == 0) return "";
        const auto seconds = static_cast<int>(watch_.seconds() * (total - done) / done);
        char text[40];
        std::snprintf(text, sizeof text, ", about %d:%02d min left", seconds / 60, seconds % 60);
        return text;
    }

    bool shown_;
    std::string stage_;
    stopwatch watch_;
};

}  // namespace

load_options scene_with_poses(const settings& s) {
    if (s.poses == pose_source::given) return s.scene;
    const command_context context(s);
    const output_folder output(s.output);
    stage_line line(s.log_level < log_level::info);
    const poses::listener user{
        .say =
            [&](const std::string& text) {
                line.clear();
                context.say(text);
            },
        .progress = [&](const std::string& stage, int done, int total) { line.show(stage, done, total); }};
    try {
        return poses::compute_poses(s.scene, output.path(), s.video_frames, user);
    } catch (const poses::interrupted& e) {
        throw interruption(e.signal, e.what());
    }
}

}  // namespace gs::cli
