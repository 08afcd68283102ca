// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdlib>

#include "image/image.hpp"
#include "poses/child_process.hpp"
#include "run_program.hpp"

namespace {

using namespace gs_test;

/// A model of the scene with spheres.
class spheres_model {
  public:
    spheres_model() {
        check_success({"train", "-d", "synthetic:spheres", "-r", "32", "-i", "5", "--effects", "none",
                       "--device", "cpu", "-q", "-o", (folder_ / "run").string()});
    }
    /// Renders with these options.
    words render(const words& more) const {
        return words{"render", model_of(folder_ / "run", 5).string(), "--device", "cpu", "-q"} + more;
    }
    fs::path file(const std::string& name) const { return folder_ / name; }

  private:
    temporary_folder folder_;
};

bool has_ffmpeg() {
    const bool has = gs::poses::is_installed("ffmpeg") && gs::poses::is_installed("ffprobe");
    if (!has) MESSAGE("skipped: ffmpeg is not installed");
    return has;
}

/// Returns values that ffprobe reads from the only stream of a video.
std::string probed(const fs::path& video, const std::string& entries) {
    std::string all;
    const int status = gs::poses::run_child("ffprobe",
                                            {"-v", "error", "-count_frames", "-show_entries",
                                             "stream=" + entries, "-of", "csv=p=0", video.string()},
                                            [&](const std::string& line) { all += line; });
    CHECK(status == 0);
    return all;
}

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

const std::string two_cameras = R"({"cameras": [
    {"position": [4, 0, 1.5], "look_at": [0, 0, 0], "up": [0, 0, 1]},
    {"position": [0, 4, 1.5], "look_at": [0, 0, 0], "up": [0, 0, 1]}], "width": 41, "height": 31})";

}  // namespace

TEST_CASE("videos: an orbit and a path become H.264 in MP4 with even sides") {
    if (!has_ffmpeg()) return;
    const spheres_model model;
    const fs::path video = model.file("new folder/a video.mp4");
    const std::string read = "codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames";
    check_success(model.render({"-o", video.string(), "-r", "65", "--seconds", "0.5", "--fps", "12"}));
    CHECK(probed(video, read) == "h264,64,36,yuv420p,12/1,6");

    write_file(model.file("path.json"), two_cameras);
    check_success(model.render({"-o", video.string(), "--path", model.file("path.json").string(), "--seconds",
                                "0.25", "--fps", "20"}));
    CHECK(probed(video, read) == "h264,40,30,yuv420p,20/1,5");
    CHECK(files_in(video.parent_path()) == 1);
}

TEST_CASE("videos: an orbit of a scene has the size and the shape of its views") {
    const spheres_model model;
    const fs::path images = model.file("orbit");
    check_success(model.render(
        {"-o", images.string(), "-d", "synthetic:spheres", "-r", "32", "--orbit", "--orbit-views", "3"}));
    CHECK(files_in(images) == 3);
    const gs::image first = gs::read_image(images / "00000.png");
    CHECK(first.width == 32);
    CHECK(first.height == 32);
    CHECK(contents(images).at("00000.png") != contents(images).at("00001.png"));
}

TEST_CASE("videos: a path becomes images in a folder") {
    const spheres_model model;
    write_file(model.file("path.json"), two_cameras);
    const fs::path images = model.file("images");
    check_success(model.render({"-o", images.string(), "--path", model.file("path.json").string(),
                                "--seconds", "0.5", "--fps", "6"}));
    CHECK(files_in(images) == 3);
    const gs::image last = gs::read_image(images / "00002.png");
    CHECK(last.width == 41);
    CHECK(last.height == 31);
}

TEST_CASE("videos: without ffmpeg, a sentence names the remedy") {
    const spheres_model model;
    const char* path = std::getenv("PATH");
    const std::string before = path ? path : "";
    setenv("PATH", model.file("nothing").c_str(), 1);
    check_refusal(model.render({"-o", model.file("a.mp4").string()}),
                  {"ffmpeg", "apt-get install", "folder"});
    setenv("PATH", before.c_str(), 1);
    CHECK_FALSE(fs::exists(model.file("a.mp4")));
}

TEST_CASE("videos: a failure of ffmpeg leaves an earlier video as it was") {
    const spheres_model model;
    const fs::path programs = model.file("programs"), video = model.file("a.mp4");
    write_file(programs / "ffmpeg",
               "#!/bin/sh\nfor last; do :; done\necho half > \"${last#file:}\"\n"
               "head -c 100 > /dev/null\necho 'no space left' >&2\nexit 1\n");
    fs::permissions(programs / "ffmpeg", fs::perms::owner_all);
    write_file(video, "an earlier video");
    const std::string before = std::getenv("PATH");
    setenv("PATH", (programs.string() + ":" + before).c_str(), 1);
    check_refusal(model.render({"-o", video.string(), "-r", "64"}), {"a.mp4", "no space left"});
    setenv("PATH", before.c_str(), 1);
    CHECK(contents(video.parent_path()).at("a.mp4") == "an earlier video");
    CHECK_FALSE(fs::exists(video.string() + ".part"));
}

TEST_CASE("videos: the views of a scene are no motion, and --orbit-views needs an orbit") {
    const spheres_model model;
    check_refusal(model.render({"-o", model.file("a.mp4").string(), "-d", "synthetic:spheres", "-r", "32"}),
                  gs::poses::is_installed("ffmpeg") ? words{"--orbit", "--path"} : words{"ffmpeg"});
    check_refusal(model.render({"-o", "x", "-d", "synthetic:spheres", "--orbit-views", "3"}), {"--orbit"});
}

TEST_CASE("videos: options without an effect are refused") {
    const spheres_model model;
    const words views{"-o", model.file("views").string(), "-d", "synthetic:spheres"};
    check_refusal(model.render(views + words{"--seconds", "3"}), {"--seconds", "--orbit", "--path"});
    check_refusal(model.render(views + words{"--fps", "3"}), {"--fps", "--orbit", "--path"});
    check_refusal(model.render({"-o", model.file("images").string(), "--fps", "3"}), {"--fps", "--seconds"});
    check_refusal(model.render({"-o", model.file("a.mp4").string(), "--orbit-views", "3"}),
                  {"--orbit-views", "images", "--seconds"});
}

TEST_CASE("videos: a folder with the name of the video is refused") {
    if (!has_ffmpeg()) return;
    const spheres_model model;
    fs::create_directories(model.file("a.mp4"));
    check_refusal(model.render({"-o", model.file("a.mp4").string()}), {"a.mp4:", "folder", "another name"});
}
