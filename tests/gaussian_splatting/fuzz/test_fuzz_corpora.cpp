// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "budget.hpp"
#include "harness.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus_of(const std::string& harness) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(WARPAGG_CORPUS) / harness))
        files.push_back(entry.path());
    std::ranges::sort(files);  // so that random mutations are the same everywhere
    return files;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string repeated(const std::string& text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

template <class T>
std::string raw(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Not a seed, for it is large: the most that memory can hold per byte of the file.
struct dense_file {
    const char* what;
    const char* harness;
    std::string bytes;
};

std::vector<dense_file> dense_files() {
    const std::string one = raw(1.0), zero = raw(0.0);
    const std::string frame =
        R"({"file_path":"","transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";
    const std::string nine_numbers = R"(,"k1":0,"k2":0,"p1":0,"p2":0,"w":1,"h":1,"cx":1,"cy":1,"fl_x":1)";
    const std::string all_numbers = nine_numbers + R"(,"fl_y":1,"camera_angle_x":1)";
    const auto frames = [](const std::string& of) {
        return "{\"frames\":[" + repeated(of + ",", 20000) + of + "]}";
    };
    const auto unread = [](const std::string& values) { return "{\"frames\":[],\"unread\":[" + values; };
    const auto opensfm = [](const std::string& section, const std::string& record) {
        return "[{" + section + ":{" + repeated(record + ",", 20000) + record + "}}]";
    };
    const std::string text_points =
        "ply\nformat ascii 1.0\nelement vertex 50000\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n";
    std::string bytes_for_floats = "ply\nformat binary_little_endian 1.0\nelement vertex 50000\n";
    for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                             "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        bytes_for_floats += "property char " + std::string(name) + "\n";
    std::string many_properties = "ply\nformat binary_little_endian 1.0\nelement vertex 0\n";
    for (int i = 0; i < 3000; ++i) many_properties += "property char " + std::to_string(i) + "\n";
    const std::uint32_t id = 1;
    const std::uint64_t none = 0, count = 20000, side = 1;
    return {
        {"binary cameras", "colmap_binary",
         '0' + raw(count) +
             repeated(raw(id) + raw(std::int32_t{0}) + raw(side) + raw(side) + one + one + one, count)},
        {"binary images", "colmap_binary",
         '1' + raw(count) +
             repeated(raw(id) + one + repeated(zero, 6) + raw(id) + std::string(1, '\0') + raw(none), count)},
        {"binary points", "colmap_binary",
         '2' + raw(count) +
             repeated(raw(none) + repeated(zero, 3) + std::string(3, '\0') + zero + raw(none), count)},
        {"text cameras", "colmap_text", '0' + repeated("1 PINHOLE 1 1 1 1 1 1\n", 20000)},
        {"text images", "colmap_text", '1' + repeated("1 1 0 0 0 0 0 0 1 a\n\n", 20000)},
        {"text points", "colmap_text", '2' + repeated("1 0 0 0 0 0 0 0\n", 20000)},
        {"a long name", "colmap_text", "11 1 0 0 0 0 0 0 1 " + std::string(1 << 20, 'a') + "\n"},
        {"a long word", "colmap_text", '0' + std::string(1 << 20, '1')},
        {"lines of one digit", "colmap_text", '0' + repeated("1\n", 300000)},
        {"frames", "transforms", frames(frame + "}")},
        {"frames that say all", "transforms", frames(frame + all_numbers + "}")},
        {"frames that say nine", "transforms", frames(frame + nine_numbers + "}")},
        {"frames that say nothing", "transforms",
         "{" + frame.substr(1) + ",\"frames\":[" + repeated("{},", 100000) + "{}]}"},
        {"frames with long paths", "transforms",
         frames(R"({"file_path":")" + std::string(100, 'a') + frame.substr(14) + "}")},
        {"frames with masks", "transforms",
         frames(frame + R"(,"mask_path":")" + std::string(16, 'a') + "\"}")},
        {"frames with empty masks", "transforms", frames(frame + R"(,"mask_path":""})")},
        {"points", "opensfm", opensfm(R"("points")", R"("":{"coordinates":[0,0,0],"color":[0,0,0]})")},
        {"shots", "opensfm",
         opensfm(R"("shots")", R"("":{"rotation":[0,0,0],"translation":[0,0,0],"camera":""})")},
        {"cameras", "opensfm",
         opensfm(R"("cameras")", R"("":{"projection_type":"fisheye","width":1,"height":1,"focal":1})")},
        {"panoramas", "opensfm",
         opensfm(R"("cameras")", R"("":{"projection_type":"spherical","width":2,"height":1})")},
        {"points in text", "point_cloud", text_points + repeated("0 0 0\n", 50000)},
        {"long texts", "transforms", unread(repeated('"' + std::string(4090, 'a') + "\",", 300) + "1]}")},
        {"a long path", "transforms", "{\"frames\":[{\"file_path\":\"" + repeated("a/", 500000)},
        {"a long number", "transforms", unread(repeated("1", 1000000))},
        {"a number cut off", "transforms", unread(repeated("1", 4090) + ".")},
        {"a text cut off", "transforms", unread("\"" + repeated("a", 4090))},
        {"a wrong character", "transforms", unread("1" + repeated("\n", 510) + "\x01")},
        {"numbers", "transforms", unread(repeated("1,", 500000) + "1]}")},
        {"lines", "transforms", unread(repeated("\n", 1000000) + "1]}")},
        {"brackets", "transforms", unread(repeated("[],", 300000) + "1]}")},
        {"infinities", "transforms", unread(repeated("-Infinity,", 100000) + "1]}")},
        {"nesting", "transforms", unread(repeated("[1,", 400000))},
        {"nesting objects", "transforms", unread(repeated("{\"\":", 300000))},
        {"bytes for floats", "ply", bytes_for_floats + "end_header\n" + std::string(14 * 50000, '\1')},
        {"many properties", "ply", many_properties + "end_header\n"},
        {"a long line", "ply", "ply\n" + std::string(1 << 20, 'a')},
        {"a long line of words", "ply", "ply\n" + repeated("a ", 500000)},
    };
}

}  // namespace

TEST_CASE("every corpus has files that are taken, and files that are refused") {
    for (const auto& [name, run] : gs_fuzz::harnesses()) {
        CAPTURE(name);
        std::size_t taken = 0, refused = 0;
        for (const fs::path& file : corpus_of(name)) {
            CAPTURE(file.filename().string());
            bool loaded = false;
            REQUIRE_NOTHROW(loaded = run(bytes_of(file)));
            ++(loaded ? taken : refused);
        }
        CHECK(taken >= 2);
        CHECK(refused >= 1);
    }
}

TEST_CASE("the files of the corpora cut off anywhere") {
    for (const auto& [name, run] : gs_fuzz::harnesses())
        for (const fs::path& file : corpus_of(name)) {
            CAPTURE(file.string());
            const std::string whole = bytes_of(file);
            for (std::size_t length = 0; length < whole.size(); ++length) {
                CAPTURE(length);
                REQUIRE_NOTHROW(run(std::string_view(whole).substr(0, length)));
            }
        }
}

TEST_CASE("the files of the corpora with some bytes changed") {
    std::mt19937 random(1);
    for (const auto& [name, run] : gs_fuzz::harnesses())
        for (const fs::path& file : corpus_of(name)) {
            CAPTURE(file.string());
            const std::string whole = bytes_of(file);
            for (int trial = 0; trial < 200; ++trial) {
                CAPTURE(trial);
                std::string changed = whole;
                for (int i = 0; i <= trial % 3; ++i)
                    changed[random() % changed.size()] = static_cast<char>(random() % 256);
                REQUIRE_NOTHROW(run(changed));
            }
        }
}

TEST_CASE("the densest files of each kind stay within four times their size") {
    for (const dense_file& one : dense_files()) {
        CAPTURE(one.what);
        CHECK_NOTHROW(gs_fuzz::harness_of(one.harness).run(one.bytes));
    }
}

TEST_CASE("memory beyond the bound is noticed, and released memory is not held against a loader") {
    if (!gs_fuzz::budget::is_counting()) return;  // without AddressSanitizer
    const std::string file(1000, 'x');
    const std::size_t allowed = 4 * file.size() + gs_fuzz::small_change;
    const auto allocating = [](std::size_t bytes, int times) {
        return [=](const fs::path&) {
            for (int i = 0; i < times; ++i)
                std::vector<char>(bytes).swap(*std::make_unique<std::vector<char>>());
        };
    };
    CHECK(gs_fuzz::load_within_budget(file, allocating(allowed - 100, 3)));
    CHECK_THROWS_AS(gs_fuzz::load_within_budget(file, allocating(allowed + 1, 1)), std::logic_error);
}
