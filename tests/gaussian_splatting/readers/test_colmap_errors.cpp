// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "colmap_model.hpp"
#include "readers/colmap/colmap.hpp"

namespace {

using namespace gs_test;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("folders that are no scene") {
    const temporary_folder folder;
    CHECK(says(error_of_loading(folder / "none"), {"none", "does not exist"}));
    write_file(folder / "file", "x");
    CHECK(says(error_of_loading(folder / "file"), {"file", "is not a scene"}));
    CHECK(says(error_of_loading(folder.path()),
               {"is not a scene", "transforms_train.json", "sparse/0", "synthetic:"}));
    std::filesystem::create_directories(folder / "sparse/0");
    CHECK(says(error_of_loading(folder.path()), {"sparse/0", "no cameras", "cameras.bin", "cameras.txt"}));
    write_file(folder / "sparse/0/cameras.bin", cameras_bin(plain_model()));
    CHECK(says(error_of_loading(folder.path()), {"sparse/0", "no images", "images.bin", "images.txt"}));
    write_file(folder / "sparse/0/images.bin", images_bin(plain_model()));
    CHECK(says(error_of_loading(folder.path()), {"folder of photos", "images", "not exist"}));
}

TEST_CASE("models that say something impossible, in binary and in text") {
    using change = std::function<void(model_record&)>;
    struct wrong_model {
        const char* what;
        change apply;
        std::vector<std::string> words;
    };
    const wrong_model cases[] = {
        {"no cameras", [](auto& m) { m.cameras.clear(); }, {"cameras", "no cameras"}},
        {"no images", [](auto& m) { m.images.clear(); }, {"images", "no images"}},
        {"model",
         [](auto& m) { m.cameras[1].model_id = 7, m.cameras[1].model = "FOV"; },
         {"cameras", "unknown", "SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, OPENCV_FISHEYE"}},
        {"fisheye",
         [](auto& m) {
             m.cameras[1] = {7, 8, "SIMPLE_RADIAL_FISHEYE", 40, 30, {44, 20, 14, infinity}};
         },
         {"cameras", "camera 7", "not finite"}},
        {"width", [](auto& m) { m.cameras[1].width = 0; }, {"cameras", "camera 7", "0x30"}},
        {"height",
         [](auto& m) { m.cameras[1].height = 1ULL << 40; },
         {"cameras", "camera 7", "40x1099511627776"}},
        {"focal", [](auto& m) { m.cameras[0].parameters[1] = 0; }, {"cameras", "camera 1", "focal length"}},
        {"negative",
         [](auto& m) { m.cameras[0].parameters[0] = -3; },
         {"cameras", "camera 1", "focal length"}},
        {"center",
         [](auto& m) { m.cameras[0].parameters[2] = infinity; },
         {"cameras", "camera 1", "not finite"}},
        {"tiny focal", [](auto& m) { m.cameras[0].parameters[0] = 1e-300; }, {"camera 1", "focal length"}},
        {"huge focal", [](auto& m) { m.cameras[0].parameters[1] = 1e300; }, {"camera 1", "focal length"}},
        {"twice", [](auto& m) { m.cameras[1].id = 1; }, {"cameras", "camera 1 twice"}},
        {"name twice", [](auto& m) { m.images[0].name = "b.png"; }, {"images", "b.png twice"}},
        {"long name",
         [](auto& m) { m.images[0].name = std::string(5000, 'x'); },
         {"images", "xxx ...", "too long"}},
        {"camera id", [](auto& m) { m.images[1].camera_id = 99; }, {"images", "a.png", "camera 99"}},
        {"zero turn",
         [](auto& m) {
             m.images[1].quaternion = {0, 0, 0, 0};
         },
         {"images", "rotation", "a.png"}},
        {"NaN turn",
         [](auto& m) { m.images[2].quaternion[3] = not_a_number; },
         {"images", "rotation", "b.png"}},
        {"huge turn", [](auto& m) { m.images[2].quaternion[3] = infinity; }, {"images", "rotation", "b.png"}},
        {"NaN place",
         [](auto& m) { m.images[0].translation[1] = not_a_number; },
         {"images", "translation", "c.png"}},
        {"NaN point", [](auto& m) { m.points[1].position[2] = not_a_number; }, {"points3D", "not finite"}},
        {"far point", [](auto& m) { m.points[0].position[0] = -infinity; }, {"points3D", "not finite"}},
        {"farther than squares go",
         [](auto& m) { m.points[0].position[0] = 1e200; },
         {"points3D", "position", "1e30"}},
        {"far camera",
         [](auto& m) { m.images[0].translation[2] = -1e200; },
         {"images", "translation", "c.png", "1e30"}},
    };
    for (const bool binary : {true, false})
        for (const wrong_model& wrong : cases) {
            CAPTURE(binary);
            CAPTURE(wrong.what);
            const temporary_folder folder;
            model_record model = plain_model();
            write_photos(folder / "images", model, 40, 30);
            wrong.apply(model);
            (binary ? write_binary : write_text)(folder / "sparse/0", model);
            const std::string problem = error_of_loading(folder.path());
            CAPTURE(problem);
            for (const std::string& word : wrong.words) CHECK(says(problem, {word}));
            CHECK(says(problem, {binary ? ".bin" : ".txt"}));
        }
}

TEST_CASE("binary models that are cut off anywhere, or too long, are refused") {
    const temporary_folder folder;
    write_scene(folder.path());
    const auto sparse = folder / "sparse/0";
    for (const char* part : {"cameras.bin", "images.bin", "points3D.bin"}) {
        CAPTURE(part);
        const std::string whole = gs_test::read_file(sparse / part);
        for (std::size_t length = 0; length < whole.size(); ++length) {
            CAPTURE(length);
            write_file(sparse / part, whole.substr(0, length));
            REQUIRE(says(error_of([&] { gs::read_colmap_model(sparse); }), {part, "truncated"}));
        }
        write_file(sparse / part, whole + "x");
        CHECK(says(error_of_loading(folder.path()), {part, "too long", "1 bytes"}));
        write_file(sparse / part, whole);
    }
    CHECK(error_of_loading(folder.path()).empty());
}

TEST_CASE("counts that lie are refused before memory is asked for") {
    const temporary_folder folder;
    write_scene(folder.path());
    const auto sparse = folder / "sparse/0";
    const auto put_count = [&](const char* part, std::size_t at, std::uint64_t count) {
        const std::string whole = gs_test::read_file(sparse / part);
        std::string lying = whole;
        std::memcpy(lying.data() + at, &count, sizeof count);
        write_file(sparse / part, lying);
        const std::string problem = error_of([&] { gs::read_colmap_model(sparse); });
        write_file(sparse / part, whole);
        return problem;
    };
    const std::size_t first_track = 8 + 8 + 3 * 8 + 3 + 8, first_tracked = 8 + 4 + 7 * 8 + 4 + 6;
    for (const std::uint64_t count : {std::uint64_t{1000}, std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
        for (const char* part : {"cameras.bin", "images.bin", "points3D.bin"})
            CHECK(says(put_count(part, 0, count), {part, "truncated"}));
        CHECK(says(put_count("points3D.bin", first_track, count), {"points3D.bin", "truncated"}));
        CHECK(says(put_count("images.bin", first_tracked, count), {"images.bin", "truncated"}));
    }
}

TEST_CASE("whatever byte of a model is changed, the outcome is an error or a model") {
    const temporary_folder folder;
    std::size_t refused = 0;
    for (const bool binary : {true, false}) {
        const auto sparse = folder / (binary ? "binary" : "text");
        (binary ? write_binary : write_text)(sparse, plain_model());
        for (const char* stem : {"cameras", "images", "points3D"}) {
            const auto file = sparse / (std::string(stem) + (binary ? ".bin" : ".txt"));
            const std::string whole = gs_test::read_file(file);
            for (std::size_t i = 0; i < whole.size(); ++i) {
                std::string changed = whole;
                changed[i] = static_cast<char>(~changed[i]);
                write_file(file, changed);
                const std::string problem = error_of([&] { gs::read_colmap_model(sparse); });
                if (problem.empty()) continue;
                ++refused;
                REQUIRE(says(problem, {stem}));
            }
            write_file(file, whole);
        }
    }
    CHECK(refused > 100);
}

TEST_CASE("malformed lines of text models are named by file and number") {
    struct wrong_line {
        const char* part;
        const char* text;
        std::vector<std::string> words;
    };
    const wrong_line cases[] = {
        {"cameras.txt", "# one\n1 PINHOLE 40 30 50 35 19\n", {"line 2", "malformed", "parameter is missing"}},
        {"cameras.txt", "1 PINHOLE 40 30 50 35 19 16 3\n", {"line 1", "malformed", "only 4 parameters"}},
        {"cameras.txt", "1 PINHOLE 40 30 50 35x 19 16\n", {"line 1", "malformed", "35x"}},
        {"cameras.txt", "one PINHOLE 40 30 50 35 19 16\n", {"line 1", "malformed", "'one'"}},
        {"cameras.txt", "1 PINHOLE -40 30 50 35 19 16\n", {"line 1", "malformed", "-40"}},
        {"cameras.txt", "1 FISHEYE 40 30 50 35 19 16\n", {"line 1", "FISHEYE", "SIMPLE_PINHOLE"}},
        {"cameras.txt", "1\n", {"line 1", "malformed", "camera model is missing"}},
        {"images.txt",
         "1 1 0 0 0 0 0 0 1 a.png\n\n\n2 1 0 0 0 0 0 0 1\n",
         {"line 4", "malformed", "name is missing"}},
        {"images.txt", "1 1 0 0 0 0 0 zero 1 a.png\n", {"line 1", "malformed", "zero"}},
        {"images.txt",
         "1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n",
         {"line 2", "malformed", "groups of 3"}},
        {"points3D.txt", "1 1 2 3 4 5 6 0.1\n2 1 2 3 4 5 600 0.1\n", {"line 2", "malformed", "600"}},
        {"points3D.txt", "1 1 2 3 4 5 6\n", {"line 1", "malformed", "error is missing"}},
        {"points3D.txt", "1 1 2 3 4 5 6 0.1 1\n", {"line 1", "malformed", "groups of 2"}},
    };
    for (const auto& [part, text, words] : cases) {
        const temporary_folder folder;
        write_text(folder / "sparse/0", plain_model());
        write_photos(folder / "images", plain_model(), 40, 30);
        REQUIRE(error_of_loading(folder.path()).empty());
        write_file(folder / "sparse/0" / part, text);
        const std::string problem = error_of_loading(folder.path());
        CAPTURE(problem);
        CHECK(says(problem, {part}));
        for (const std::string& word : words) CHECK(says(problem, {word}));
    }
}

TEST_CASE("a word that is no number is shown, but not all of it, nor what would steer a terminal") {
    const temporary_folder folder;
    write_text(folder / "sparse/0", plain_model());
    write_file(folder / "sparse/0/cameras.txt", "1\x1B[2J" + std::string(10000, '1') + " PINHOLE\n");
    const std::string problem = error_of_loading(folder.path());
    CHECK(says(problem, {"line 1", "malformed", "1?[2J11111", "1 ...'"}));
    CHECK(problem.size() < 1000);
}

TEST_CASE("photos that are missing or unreadable are named, the first by name") {
    const temporary_folder folder;
    write_scene(folder.path());
    const std::string good = gs_test::read_file(folder / "images/a.png");
    const std::string cut = good.substr(0, good.size() - 20);
    write_file(folder / "images/b.png", cut);
    write_file(folder / "images/c.png", cut);
    CHECK(says(error_of_loading(folder.path()), {"b.png", "truncated"}));
    std::filesystem::remove(folder / "images/b.png");
    CHECK(says(error_of_loading(folder.path()), {"b.png", "no such file"}));
    write_file(folder / "images/b.png", "no image");
    CHECK(says(error_of_loading(folder.path()), {"b.png", "not a PNG"}));
}
