// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "colmap_model.hpp"

using namespace gs_test;

namespace {

constexpr std::int32_t a_camera = 0, an_imu = 1;

struct sensor_record {
    std::int32_t kind;
    std::uint64_t data;
};

struct frame_record {
    std::uint32_t id;
    std::vector<sensor_record> sensors;
};

std::string frames_bin(const std::vector<frame_record>& frames) {
    bytes out;
    out.put(std::uint64_t{frames.size()});
    for (const auto& f : frames) {
        out.put(f.id).put(std::uint32_t{1}).put(std::array<double, 7>{1, 0, 0, 0, 0, 0, 0});
        out.put(static_cast<std::uint32_t>(f.sensors.size()));
        for (const auto& s : f.sensors) out.put(s.kind).put(std::uint32_t{2}).put(s.data);
    }
    return out.data();
}

std::string frames_txt(const std::vector<frame_record>& frames) {
    std::string out = "# Frame list\n";
    for (const auto& f : frames) {
        out += std::to_string(f.id) + " 1 1 0 0 0 0 0 0 " + std::to_string(f.sensors.size());
        for (const auto& s : f.sensors)
            out += std::string(s.kind == a_camera ? " CAMERA" : " IMU") + " 2 " + std::to_string(s.data);
        out += "\n";
    }
    return out;
}

// The images of the plain model are, by id, c.png, a.png and b.png. Views are sorted by name.
const std::vector<frame_record> frames = {{8, {{a_camera, 1}, {an_imu, 3}, {a_camera, 2}}},
                                          {9, {{a_camera, 77}, {a_camera, 3}}}};

}  // namespace

TEST_CASE("COLMAP: photos of one frame are those of a rig, in binary and in text") {
    for (const bool is_text : {false, true}) {
        CAPTURE(is_text);
        const temporary_folder folder;
        write_scene(folder.path());
        const auto of_views = [&] {
            std::vector<std::optional<std::uint32_t>> found;
            for (const gs::view& v : gs::load_scene(options_for(folder.path()), ignore).train)
                found.push_back(v.rig_frame);
            return found;
        };
        CHECK(of_views() == std::vector<std::optional<std::uint32_t>>(3));  // before COLMAP 3.12
        is_text ? write_file(folder / "sparse/0/frames.txt", frames_txt(frames))
                : write_file(folder / "sparse/0/frames.bin", frames_bin(frames));
        CHECK(of_views() == std::vector<std::optional<std::uint32_t>>{8, 9, 8});
    }
}

TEST_CASE("COLMAP: malformed frames are refused with the file, and the line of a text file") {
    const temporary_folder folder;
    write_scene(folder.path());
    const std::string whole = frames_txt(frames);
    write_file(folder / "sparse/0/frames.txt", whole + "10 1 1 0 0 0 0 0 0 1 CAMERA 2\n");
    CHECK(says(error_of_loading(folder.path()), {"frames.txt line 4", "the image's id is missing"}));
    write_file(folder / "sparse/0/frames.txt", whole + "10 1 1 0 0 0 0 0 0 1 CAMERA 2 3 4\n");
    CHECK(says(error_of_loading(folder.path()), {"frames.txt line 4", "more images than it promises"}));
    write_file(folder / "sparse/0/frames.bin", frames_bin(frames).substr(0, 100));
    CHECK(says(error_of_loading(folder.path()), {"frames.bin", "truncated"}));
    write_file(folder / "sparse/0/frames.bin", frames_bin(frames) + "x");
    CHECK(says(error_of_loading(folder.path()), {"frames.bin", "too long"}));
}
