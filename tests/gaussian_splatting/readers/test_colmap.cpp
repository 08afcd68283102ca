// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "known_lenses.hpp"
#include "readers/colmap/colmap.hpp"

namespace {

using namespace gs_test;

bool same(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    return glm::distance(a, b) <= tolerance;
}

std::filesystem::path real_scene(const std::string& name) {
    const char* named = std::getenv("WARPAGG_DATA");
    const std::filesystem::path data =
        named ? std::filesystem::path(named) : std::filesystem::path(WARPAGG_SOURCE_DIR) / "../shared/data";
    return data / name;
}

}  // namespace

TEST_CASE("a COLMAP model reads the same from binary and from text") {
    const temporary_folder folder;
    model_record written = plain_model();
    for (const auto& lens : {simple_radial(0.1), radial(-0.05, 0.01), opencv(0.01, -0.02, 3e-3, -4e-3)}) {
        written.cameras.push_back(lens.camera);
        written.cameras.back().id = static_cast<std::uint32_t>(10 + written.cameras.size());
    }
    write_binary(folder / "binary", written);
    write_text(folder / "text", written);
    const gs::colmap_model binary = gs::read_colmap_model(folder / "binary");
    const gs::colmap_model text = gs::read_colmap_model(folder / "text");

    REQUIRE(binary.cameras.size() == 5);
    REQUIRE(text.cameras.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
        const gs::colmap_camera &a = binary.cameras[i], &b = text.cameras[i];
        CHECK(a.id == written.cameras[i].id);
        CHECK(a.id == b.id);
        CHECK(a.model().name == written.cameras[i].model);
        CHECK(b.model().name == written.cameras[i].model);
        CHECK(std::array{a.fx, a.fy, a.cx, a.cy} == std::array{b.fx, b.fy, b.cx, b.cy});
        CHECK(std::pair{a.width, a.height} == std::pair{b.width, b.height});
        CHECK(a.coefficients == b.coefficients);
    }
    const gs::lens full = binary.cameras[4].distortion();
    CHECK(std::array{full.k1, full.k2, full.p1, full.p2} == std::array{0.01, -0.02, 3e-3, -4e-3});
    CHECK(binary.cameras[3].distortion().k2 == 0.01);
    CHECK(binary.cameras[2].distortion().k1 == 0.1);

    REQUIRE(binary.images.size() == 3);
    REQUIRE(text.images.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(binary.name(binary.images[i]) == written.images[i].name);
        CHECK(text.name(text.images[i]) == written.images[i].name);
        CHECK(binary.images[i].camera_id == written.images[i].camera_id);
        CHECK(binary.images[i].camera_id == text.images[i].camera_id);
        CHECK(binary.images[i].rotation == text.images[i].rotation);
        CHECK(binary.images[i].translation == text.images[i].translation);
    }
    REQUIRE(binary.points.size() == 2);
    REQUIRE(text.points.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& p = written.points[i];
        CHECK(binary.points[i].position == glm::dvec3(p.position[0], p.position[1], p.position[2]));
        CHECK(binary.points[i].color == glm::u8vec3(p.color[0], p.color[1], p.color[2]));
        CHECK(binary.points[i].position == text.points[i].position);
        CHECK(binary.points[i].color == text.points[i].color);
    }
}

TEST_CASE("a known camera comes back from its file") {
    const temporary_folder folder;
    write_scene(folder.path());
    const gs::scene scene = gs::load_scene(options_for(folder.path()), ignore);
    CHECK_FALSE(scene.object_centered);
    CHECK_FALSE(scene.rendered);
    CHECK_FALSE(scene.has_alpha);
    CHECK(scene.points.size() == 2);
    CHECK(scene.test.empty());
    REQUIRE(scene.train.size() == 3);
    CHECK(scene.train[0].name == "a.png");
    CHECK(scene.train[1].name == "b.png");
    CHECK(scene.train[2].name == "c.png");
    const gs::camera &a = scene.train[0].camera, &b = scene.train[1].camera, &c = scene.train[2].camera;
    CHECK(std::array{a.fx, a.fy, a.cx, a.cy} == std::array{50.0, 35.0, 19.0, 16.0});
    CHECK(std::array{c.fx, c.fy, c.cx, c.cy} == std::array{44.0, 44.0, 20.5, 14.0});
    CHECK(a.rotation == glm::dmat3(1));
    CHECK(a.center() == glm::dvec3(0));
    // A quarter turn about -z takes x to -y and y to x.
    CHECK(same(b.rotation * glm::dvec3(1, 0, 0), {0, -1, 0}, rounding));
    CHECK(same(b.rotation * glm::dvec3(0, 1, 0), {1, 0, 0}, rounding));
    CHECK(same(b.rotation * b.center() + b.translation, glm::dvec3(0), rounding));
    CHECK(b.translation == glm::dvec3(1, 2, 3));
    // The quaternion of c is not of length 1; its rotation keeps lengths all the same, and its axis.
    const glm::dmat3 product = glm::transpose(c.rotation) * c.rotation;
    for (int column = 0; column < 3; ++column) CHECK(same(product[column], glm::dmat3(1)[column], rounding));
    CHECK(same(c.rotation * glm::dvec3(-0.1, 0.7, 0.2), {-0.1, 0.7, 0.2}, rounding));
    CHECK(glm::determinant(c.rotation) > 0);
}

TEST_CASE("text models may have comments, blank lines, Windows line ends and names with blanks") {
    const temporary_folder folder;
    write_file(folder / "sparse/cameras.txt", "# c\r\n\r\n  3 PINHOLE 40 30 50 35 19 16 \r\n");
    write_file(
        folder / "sparse/images.txt",
        "# i\r\n1 1 0 0 0 0 0 0 3 a b.png\r\n\r\n# between\r\n2 1 0 0 0 1 0 0 3 d.png\r\n1 2 -1 3 4 5\r\n"
        "3 1 0 0 0 2 0 0 3 e.png");
    write_photo(folder / "images/a b.png", 40, 30);
    write_photo(folder / "images/d.png", 40, 30);
    write_photo(folder / "images/e.png", 40, 30);
    std::string said;
    const gs::scene scene =
        gs::load_scene(options_for(folder.path()), [&](const std::string& line) { said += line; });
    REQUIRE(scene.train.size() == 3);
    CHECK(scene.train[0].name == "a b.png");
    CHECK(scene.train[1].camera.translation == glm::dvec3(1, 0, 0));
    CHECK(scene.train[2].camera.translation == glm::dvec3(2, 0, 0));
    CHECK(scene.points.empty());
    CHECK(says(said, {"no points"}));
}

TEST_CASE("sparse/0 is preferred to sparse, and binary to text") {
    const temporary_folder folder;
    model_record wrong = plain_model();
    for (auto& c : wrong.cameras) c.parameters[0] = 99;
    write_photos(folder / "images", wrong, 40, 30);
    write_text(folder / "sparse", wrong);
    CHECK(gs::load_scene(options_for(folder.path()), ignore).train[0].camera.fx == 99);
    write_text(folder / "sparse/0", wrong);
    write_binary(folder / "sparse/0", plain_model());
    CHECK(gs::load_scene(options_for(folder.path()), ignore).train[0].camera.fx == 50);
}

TEST_CASE("every n-th view by name is held out, from the first") {
    const temporary_folder folder;
    model_record model = plain_model();
    model.images.clear();
    for (const int i : {7, 3, 9, 0, 4, 1, 8, 2, 6, 5})
        model.images.push_back({{1, 0, 0, 0}, {double(i), 0, 0}, 1, "p" + std::to_string(i) + ".png", {}});
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 30);
    auto options = options_for(folder.path());
    CHECK(gs::load_scene(options, ignore).train.size() == 10);
    options.eval = true;
    gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train.size() == 8);
    REQUIRE(scene.test.size() == 2);
    CHECK(scene.test[0].name == "p0.png");
    CHECK(scene.test[1].name == "p8.png");
    CHECK(scene.test[1].camera.translation.x == 8);
    options.test_every = 3;
    scene = gs::load_scene(options, ignore);
    REQUIRE(scene.test.size() == 4);
    CHECK(scene.test[3].name == "p9.png");
    CHECK(scene.train[1].name == "p2.png");
    options.test_every = 1;
    CHECK(says(error_of_loading(options), {"no training views", "10 held out"}));
    options.test_every = 0;
    CHECK(says(error_of_loading(options), {"test_every", "at least 1", "0"}));
}

TEST_CASE("the extent is 1.1 times the farthest camera's distance from their mean") {
    gs::scene scene;
    CHECK(scene.extent() == 0);
    for (const double x : {0.0, 2.0, 7.0}) {
        scene.train.emplace_back();
        scene.train.back().camera.rotation = glm::dmat3({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});
        scene.train.back().camera.translation = -scene.train.back().camera.rotation * glm::dvec3(x, 5, 5);
    }
    CHECK(scene.extent() == doctest::Approx(1.1 * 4).epsilon(rounding));
}

TEST_CASE("the extent of a single camera is how far the points are") {
    gs::scene scene;
    scene.train.emplace_back();
    CHECK(scene.extent() == 1);
    for (const double x : {1.0, 2.0, 90.0}) scene.points.push_back({{0, x, 0}, {}});
    CHECK(scene.extent() == 2);

    // On a tripod: several cameras, in one place but for rounding.
    scene.train.clear();
    const glm::dvec3 tripod(0.1, 0.2, 0.3);
    for (const double turn : {0.1, 1.3, 2.9}) {
        scene.train.emplace_back();
        gs::camera& camera = scene.train.back().camera;
        camera.rotation =
            glm::dmat3({std::cos(turn), std::sin(turn), 0}, {-std::sin(turn), std::cos(turn), 0}, {0, 0, 1});
        camera.translation = -camera.rotation * tripod;
    }
    CHECK(scene.extent() == doctest::Approx(glm::distance(tripod, {0, 2, 0})));
}

TEST_CASE("the real scene truck loads") {
    const auto folder = real_scene("truck");
    if (!std::filesystem::exists(folder)) {
        MESSAGE("skipped: " << folder.string() << " is not there");
        return;
    }
    auto options = options_for(folder);
    options.eval = true;
    const gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train.size() == 9);
    CHECK(scene.test.size() == 2);
    CHECK(scene.points.size() == 2866);
    CHECK(scene.extent() > 0);
    const gs::camera& c = scene.train[0].camera;
    CHECK(std::lround(c.fx) == 537);
    CHECK(std::lround(c.fy) == 423);
    CHECK(std::pair{c.width, c.height} == std::pair{593, 359});
    // The points were triangulated from these photos: most of them must be seen by most of the cameras.
    std::size_t seen = 0;
    for (const auto& point : scene.points)
        for (const gs::view& view : scene.train) {
            const glm::dvec3 p = view.camera.rotation * point.position + view.camera.translation;
            const glm::dvec2 at = project(view.camera, point.position);
            seen += p.z > 0 && at.x > 0 && at.y > 0 && at.x < c.width && at.y < c.height;
        }
    CHECK(seen > scene.points.size());
}
