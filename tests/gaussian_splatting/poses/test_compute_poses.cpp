// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../image/make_images.hpp"
#include "fake_programs.hpp"
#include "poses/child_process.hpp"
#include "poses/colmap_run.hpp"
#include "poses/compute_poses.hpp"
#include "readers/load_scene.hpp"

using namespace gs_test;
using namespace gs::poses;

namespace fs = std::filesystem;

namespace {

/// Photos in a folder, an output folder, and what the user is told.
struct fixture {
    temporary_folder folder;
    fs::path data = folder / "my photos", output = folder / "out";
    std::string said;

    explicit fixture(int photos = 6) { write_photos(data, photos); }

    gs::load_options compute(std::optional<int> video_frames = {},
                             const std::function<void(const std::string&)>& on_progress = {}) {
        said.clear();
        gs::load_options source;
        source.data = data.string();
        const listener user{.say = [&](const std::string& line) { said += line + "\n"; },
                            .progress =
                                [&](const std::string& stage, int done, int) {
                                    if (done > 0 && on_progress) on_progress(stage);
                                }};
        return compute_poses(source, output, video_frames, user);
    }

    std::string refusal(std::optional<int> video_frames = {}) {
        return error_of([&] { compute(video_frames); });
    }

    /// The names in the output folder.
    std::set<std::string> results() const {
        std::set<std::string> names;
        if (fs::exists(output))
            for (const auto& entry : fs::directory_iterator(output))
                names.insert(entry.path().filename().string());
        return names;
    }
};

gs::scene load(gs::load_options options) { return gs::load_scene(options, {}); }

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace

TEST_CASE("poses of photos are a COLMAP scene that links to the photos") {
    fixture f;
    write_photos(f.data / "sub folder", 2);
    write_file(f.data / "notes.txt", "not a photo");
    write_file(f.data / ".hidden.png", "not a photo");
    fake_programs fakes;
    fakes.models = "8";
    fakes.install();
    const gs::load_options computed = f.compute();
    CHECK(computed.data == (f.output / "colmap").string());
    const gs::scene scene = load(computed);
    CHECK(scene.train.size() == 8);
    CHECK(scene.points.size() == 3);
    CHECK(f.results() == std::set<std::string>{"colmap"});
    CHECK(fs::is_directory(f.output / "colmap/sparse/0"));
    CHECK(fs::is_regular_file(f.output / "colmap/database.db"));
    CHECK(says(f.said,
               {"features of 8 photos of 1 camera", "each photo with all others", "poses of 8 of 8 photos"}));
    const std::string calls = fakes.calls();
    CHECK(count(calls, "\n") == 3);
    CHECK(says(calls, {"--SiftExtraction.use_gpu 0", "--SiftMatching.use_gpu 0",
                       "--ImageReader.single_camera 1", "exhaustive_matcher"}));
    CHECK(says(read_file(f.output / "colmap/colmap.log"), {"$ colmap mapper", "Registering image #8"}));
}

TEST_CASE("poses of the same photos are used again, also after the photos are moved") {
    fixture f;
    fake_programs fakes;
    fakes.install();
    f.compute();
    fakes.calls();
    f.compute();
    CHECK(says(f.said, {"again", "photos are the same"}));
    const fs::path moved = f.folder / "moved";
    fs::rename(f.data, moved);
    CHECK(says(error_of([&] { load({.data = (f.output / "colmap").string()}); }), {"images", "--images"}));
    CHECK(load({.data = (f.output / "colmap").string(), .images = moved.string()}).train.size() == 6);
    f.data = moved;
    CHECK(load(f.compute()).train.size() == 6);
    CHECK(fakes.calls().empty());
}

TEST_CASE("poses are computed again after photos change") {
    fixture f;
    fake_programs fakes;
    fakes.install();
    f.compute();
    fakes.calls();
    SUBCASE("a new photo") {
        write_photos(f.data / "more", 1);
        fakes.models = "7";
        fakes.install();
    }
    SUBCASE("a photo that was edited") {
        const fs::path photo = fs::directory_iterator(f.data)->path();
        fs::last_write_time(photo, fs::last_write_time(photo) + std::chrono::seconds(1));
    }
    SUBCASE("a damaged record") { write_file(f.output / "colmap/photos.json", "{"); }
    f.compute();
    CHECK(says(fakes.calls(), {"feature_extractor", "mapper"}));
    CHECK(f.results() == std::set<std::string>{"colmap"});
}

TEST_CASE("the folder of photos is never changed") {
    fixture f;
    fake_programs fakes;
    fakes.install();
    f.output = f.data / "out";
    const auto names_of = [&] {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(f.data)) names.insert(entry.path().filename());
        return names;
    };
    const auto before = names_of();
    f.compute();
    CHECK(names_of().size() == before.size() + 1);
    write_photos(f.output / "test", 3);
    f.compute();
    CHECK(says(f.said, {"photos are the same"}));
    f.output = f.data;
    CHECK(says(f.refusal(), {"is the folder of the photos"}));
}

TEST_CASE("photos and masks are found in a scene folder without poses") {
    fixture f(0);
    write_photos(f.data / "images", 6);
    for (const auto& entry : fs::directory_iterator(f.data / "images"))
        fs::create_directories(f.data / "masks"),
            fs::copy_file(entry.path(), f.data / "masks" / entry.path().filename());
    fake_programs fakes;
    fakes.install();
    CHECK(load(f.compute()).train.size() == 6);
    CHECK(fs::equivalent(f.output / "colmap/masks", f.data / "masks"));
}

TEST_CASE("photos of different sizes get one camera for each size") {
    fixture f;
    write_photos(f.data, 2, fake_programs::height + 3);
    fake_programs fakes;
    fakes.install();
    f.compute();
    CHECK(count(fakes.calls(), "feature_extractor") == 2);
    CHECK(says(f.said, {"features of 8 photos of 2 cameras"}));
    const auto groups = groups_of_equal_size({f.data, {}});
    CHECK(groups.empty());
}

TEST_CASE("only small sets of photos are matched exhaustively") {
    const auto names = [](std::size_t count) { return std::vector<std::string>(count, "a.png"); };
    CHECK(matches_exhaustively({"", names(100)}));
    CHECK_FALSE(matches_exhaustively({"", names(1000)}));
    CHECK_FALSE(matches_exhaustively({"", names(20), true}));
}

TEST_CASE("other sets are matched with neighbors, and from end to beginning") {
    CHECK(pairs_to_match(30).size() == 30 * 29 / 2);
    const auto pairs = pairs_to_match(600);
    CHECK(pairs.size() < 600 * 10 + 60 * 59 / 2);
    for (std::size_t i = 0; i + 1 < 600; ++i) CHECK(pairs.contains({i, i + 1}));
    CHECK(pairs.contains({0, 590}));
    CHECK(std::ranges::all_of(
        pairs, [](const auto& pair) { return pair.first < pair.second && pair.second < 600; }));
}

TEST_CASE("a large set of photos is matched with neighbors") {
    fixture f(0);
    fake_programs fakes;
    fakes.models = "151";
    fakes.install();
    SUBCASE("names without spaces") {
        write_photos(f.data, 1);
        const fs::path photo = fs::directory_iterator(f.data)->path();
        for (int i = 0; i < 151; ++i) fs::copy_file(photo, f.data / ("photo_" + std::to_string(i) + ".png"));
        fs::remove(photo);
        f.compute();
        CHECK(says(fakes.calls(), {"matches_importer --match_type pairs"}));
        CHECK(says(f.said, {"with its neighbors", "poses of 151 of 151"}));
    }
    SUBCASE("names with spaces") {
        write_photos(f.data, 151);
        CHECK(says(f.refusal(), {"spaces in their names", "rename a 'photo'"}));
        CHECK_FALSE(says(fakes.calls(), {"colmap"}));
    }
}

TEST_CASE("the largest of several models is used") {
    fixture f(12);
    fake_programs fakes;
    fakes.models = "5 11 2";
    fakes.install();
    CHECK(load(f.compute()).train.size() == 11);
    CHECK(says(f.said, {"poses of 11 of 12 photos", "largest of 3 models"}));
    CHECK_FALSE(says(f.said, {"warning"}));
    CHECK_FALSE(fs::exists(f.output / "colmap/models"));
}

TEST_CASE("photos without a pose are named if there are many") {
    fixture f(12);
    fake_programs fakes;
    fakes.models = "10";
    fakes.install();
    f.compute();
    CHECK(says(f.said, {"warning: only 10 of 12 photos have poses", "a 'photo' $910.png"}));
}

TEST_CASE("too few poses are an error with advice") {
    fixture f(12);
    fake_programs fakes;
    SUBCASE("few photos have poses") { fakes.models = "4"; }
    SUBCASE("the mapper finds no model and fails") { fakes.models = ""; }
    fakes.install();
    CHECK(says(f.refusal(), {"of 12 photos", "take sharp photos", (f.output / "colmap.log").string()}));
    CHECK(f.results() == std::set<std::string>{"colmap.log"});
    fakes.models = "12";
    fakes.install();
    f.compute();
    CHECK(f.results() == std::set<std::string>{"colmap"});
}

TEST_CASE("a failure of COLMAP names the stage, the line that explains it, and the log") {
    fixture f;
    fake_programs fakes;
    for (const auto& [stage, name] :
         {std::pair("feature_extractor", "features"), std::pair("exhaustive_matcher", "matching")}) {
        CAPTURE(stage);
        fakes.failing_stage = stage;
        fakes.install();
        CHECK(says(f.refusal(), {name, "exit status 1", "ERROR: the ", (f.output / "colmap.log").string()}));
        CHECK(f.results() == std::set<std::string>{"colmap.log"});
        CHECK(says(read_file(f.output / "colmap.log"), {"a line that follows"}));
    }
}

TEST_CASE("an interruption ends COLMAP and leaves nothing behind") {
    fixture f;
    fake_programs fakes;
    fakes.hanging_stage = "exhaustive_matcher";
    fakes.install();
    std::signal(SIGINT, SIG_DFL);  // a shell may have started the test with this signal ignored
    CHECK_THROWS_AS(f.compute({},
                              [](const std::string& stage) {
                                  if (stage == "matching") std::raise(SIGINT);
                              }),
                    interrupted);
    CHECK(f.results().empty());
}

TEST_CASE("a folder colmap that has another origin is not replaced") {
    fixture f;
    fake_programs fakes;
    fakes.install();
    write_file(f.output / "colmap/sparse/0/cameras.bin", "mine");
    CHECK(says(f.refusal(), {"not written by --poses auto", "another --output"}));
    CHECK(read_file(f.output / "colmap/sparse/0/cameras.bin") == "mine");
}

TEST_CASE("missing programs are named with their packages") {
    fixture f;
    const fake_programs fakes;
    fakes.install_only({"ffmpeg", "ffprobe"});
    CHECK(f.refusal() ==
          "--poses auto needs COLMAP, which is not installed: install the package colmap (apt-get install "
          "colmap)");
    f.data = f.folder / "clip.mp4";
    write_file(f.data, "a video");
    fakes.install_only({"colmap", "ffprobe"});
    CHECK(says(f.refusal(), {"needs ffmpeg", "apt-get install ffmpeg"}));
    fakes.install_only({"colmap", "ffmpeg"});
    CHECK(says(f.refusal(), {"needs ffprobe", "apt-get install ffmpeg"}));
    CHECK(f.results().empty());
}

TEST_CASE("data that COLMAP cannot use is refused") {
    fixture f(4);
    const fake_programs fakes;
    fakes.install();
    CHECK(says(f.refusal(), {"at least 5 photos", "has 4"}));
    CHECK(says(f.refusal(20), {"--video-frames does not apply to photos"}));
    f.data = "synthetic:spheres";
    CHECK(says(f.refusal(), {"has camera poses", "leave out --poses auto"}));
    f.data = f.folder / "nowhere";
    CHECK(says(f.refusal(), {"does not exist"}));
    write_file(f.data, "text");
    CHECK(says(f.refusal(), {"neither a folder of photos nor a video"}));
    f.data = f.folder / "broken";
    write_photos(f.data, 5);
    write_file(f.data / "z.jpg", "text");
    CHECK(says(f.refusal(), {"z.jpg"}));
}

TEST_CASE("the sharpest frames of a video are matched in order") {
    fixture f(0);
    f.data = f.folder / "my: clip.MOV";
    write_file(f.data, "a video");
    fake_programs fakes;
    SUBCASE("") {
        fakes.install();
        const gs::load_options computed = f.compute(8);
        CHECK(load(computed).train.size() == 6);
        const std::string calls = fakes.calls();
        CHECK(says(calls, {"file:" + f.data.string(), "matches_importer", "not(mod(n\\,1))",
                           "select=eq(n\\,3)+eq(n\\,7)+eq(n\\,11)"}));
        CHECK(says(f.said, {"sharpest 8 of 40 video frames", "poses of 6 of 8"}));
        fs::rename(f.output, f.folder / "moved");
        CHECK(load({.data = (f.folder / "moved/colmap").string()}).train.size() == 6);
        fs::rename(f.folder / "moved", f.output);
        f.compute(8);
        CHECK(fakes.calls().empty());
        f.compute(6);
        CHECK_FALSE(fakes.calls().empty());
    }
    SUBCASE("a broken video") {
        fakes.has_broken_video = true;
        fakes.install();
        CHECK(says(f.refusal(), {"ffprobe", "Invalid data found", (f.output / "colmap.log").string()}));
    }
}

TEST_CASE("photos without poses are refused with the step that is missing") {
    const fixture f;
    CHECK(says(error_of([&] { load({.data = f.data.string()}); }),
               {f.data.string(), "photos without camera poses", "--poses auto"}));
    const fs::path video = f.folder / "clip.mp4";
    write_file(video, "a video");
    CHECK(says(error_of([&] { load({.data = video.string()}); }),
               {video.string(), "a video without camera poses", "--poses auto"}));
}

TEST_CASE("photos that COLMAP cannot read are converted, and all photos are trained on") {
    fixture f(4);
    constexpr int width = fake_programs::width, height = fake_programs::height;
    const std::vector<std::uint8_t> gray(4 * width * height, 128);
    write_file(f.data / "phone/a.webp", webp_of(width, height, gray, 100));
    write_file(f.data / "phone/B.WEBP", webp_of(width, height, gray, 100));
    fake_programs fakes;
    fakes.install();
    const gs::scene scene = load(f.compute());
    CHECK(scene.train.size() == 6);
    CHECK(std::ranges::count_if(scene.train,
                                [](const gs::view& v) { return v.name.starts_with("phone/"); }) == 2);
    CHECK(says(f.said, {"converted 2 photos that COLMAP cannot read to PNG"}));
    CHECK(fs::read_symlink(f.output / "colmap/images") == "photos");
    CHECK(fs::is_regular_file(f.output / "colmap/photos/phone/B.WEBP.png"));
    CHECK_FALSE(fs::exists(f.data / "phone/a.webp.png"));

    fs::rename(f.output, f.folder / "moved");
    CHECK(load({.data = (f.folder / "moved/colmap").string()}).train.size() == 6);
    f.output = f.folder / "moved";
    CHECK(load(f.compute()).train.size() == 6);
    CHECK(says(f.said, {"photos are the same"}));

    write_file(f.data / "phone/c.heic", "no image");
    CHECK(says(f.refusal(), {"cannot read the image", "c.heic"}));
}
