// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "../../support/temporary_folder.hpp"
#include "core/error.hpp"
#include "video/camera_path.hpp"

using gs::video::camera_path;
using gs::video::key_view;

namespace {

using namespace gs_test;

camera_path path_of(const std::string& json) {
    const temporary_folder folder;
    write_file(folder / "path.json", json);
    return gs::video::read_camera_path(folder / "path.json");
}

void check_near(const glm::dvec3& a, const glm::dvec3& b) {
    for (int axis = 0; axis < 3; ++axis) CHECK(a[axis] == doctest::Approx(b[axis]).epsilon(1e-9).scale(1));
}

glm::dvec3 forward(const key_view& v) { return v.axes * glm::dvec3(0, 0, 1); }
glm::dvec3 up(const key_view& v) { return v.axes * glm::dvec3(0, -1, 0); }

/// A camera of ours at x, which looks along y with z up.
std::string camera_at(double x, double degrees) {
    const std::string at = std::to_string(x);
    return R"({"position": [)" + at + R"(, 2, 3], "look_at": [)" + at +
           R"(, 7, 3], "up": [0, 0, 1], "field_of_view": )" + std::to_string(degrees) + "}";
}

}  // namespace

TEST_CASE("camera path: our format gives positions, targets and fields of view") {
    const camera_path path =
        path_of(R"({"cameras": [)" + camera_at(1, 90) + R"(], "seconds": 2.5, "width": 64, "height": 48})");
    REQUIRE(path.views.size() == 1);
    check_near(path.views[0].position, {1, 2, 3});
    check_near(forward(path.views[0]), {0, 1, 0});
    check_near(up(path.views[0]), {0, 0, 1});
    CHECK(path.views[0].field_of_view == doctest::Approx(std::numbers::pi / 2));
    CHECK(path.seconds == 2.5);
    CHECK(path.width == 64);
    CHECK(path.height == 48);
}

TEST_CASE("camera path: nerfstudio's matrices have y up and z backward") {
    // The camera looks along world y, with world z up: its x, y and z are world x, z and -y.
    const camera_path path =
        path_of(R"({"camera_type": "perspective", "render_height": 48, "render_width": 64,
        "fps": 24, "seconds": 4, "keyframes": [],
        "camera_path": [{"camera_to_world": [1,0,0,5, 0,0,-1,6, 0,1,0,7, 0,0,0,1], "fov": 60, "aspect": 1}]})");
    REQUIRE(path.views.size() == 1);
    check_near(path.views[0].position, {5, 6, 7});
    check_near(forward(path.views[0]), {0, 1, 0});
    check_near(up(path.views[0]), {0, 0, 1});
    CHECK(path.views[0].field_of_view == doctest::Approx(std::numbers::pi / 3));
    CHECK(path.seconds == 4);
    CHECK(path.width == 64);
}

TEST_CASE("camera path: it passes through its key views at equal times") {
    const camera_path path = path_of(R"({"cameras": [)" + camera_at(0, 40) + "," + camera_at(3, 50) + "," +
                                     camera_at(4, 90) + "]}");
    for (int i = 0; i < 3; ++i) {
        const key_view there = path.at(i / 2.0);
        check_near(there.position, path.views[static_cast<std::size_t>(i)].position);
        CHECK(there.field_of_view == doctest::Approx(path.views[static_cast<std::size_t>(i)].field_of_view));
    }
    CHECK(path.at(0.25).field_of_view == doctest::Approx(45 * std::numbers::pi / 180));
    // The curve has no corner at the key view: both sides have the same direction and speed.
    const double step = 1e-6, before = path.at(0.5).position.x - path.at(0.5 - step).position.x,
                 after = path.at(0.5 + step).position.x - path.at(0.5).position.x;
    CHECK(before == doctest::Approx(after).epsilon(1e-4));
    check_near(path.at(-1).position, path.views[0].position);
    check_near(path.at(2).position, path.views[2].position);
}

TEST_CASE("camera path: a quarter turn is half done in the middle") {
    const camera_path path = path_of(R"({"cameras": [
        {"position": [0,0,0], "look_at": [0,1,0], "up": [0,0,1]},
        {"position": [0,0,0], "look_at": [1,0,0], "up": [0,0,1]}]})");
    check_near(forward(path.at(0.5)), {std::sqrt(0.5), std::sqrt(0.5), 0});
    check_near(up(path.at(0.5)), {0, 0, 1});
}

TEST_CASE("camera path: a camera projects the point that it looks at to the center") {
    const camera_path path = path_of(R"({"cameras": [)" + camera_at(1, 90) + "]}");
    gs::normalization n;
    n.origin = {1, 1, 1};
    n.scale = 2;
    const gs::camera c = gs::video::camera_of(path.views[0], n, 60, 40);
    const auto center = c.see(n.to_internal({1, 7, 3})), top = c.see(n.to_internal({1, 7, 8}));
    CHECK(center->x == doctest::Approx(30));
    CHECK(center->y == doctest::Approx(20));
    CHECK(center->depth == doctest::Approx(2.5));
    CHECK(top->x == doctest::Approx(30));
    CHECK(top->y == doctest::Approx(0).scale(1));
}

TEST_CASE("camera path: malformed files are refused with the value") {
    const auto check_refused = [](const std::string& json, std::initializer_list<std::string_view> culprits) {
        CAPTURE(json);
        try {
            path_of(json);
            FAIL("it was accepted");
        } catch (const gs::error& e) {
            CHECK(says(e.what(), {"path.json"}));
            CHECK(says(e.what(), culprits));
        }
    };
    check_refused("", {"no valid JSON"});
    check_refused("[]", {"object"});
    check_refused("{}", {"cameras"});
    check_refused(R"({"cameras": []})", {"cameras"});
    check_refused(R"({"cameras": {"a": 1}})", {"cameras"});
    check_refused(R"({"cameras": [7]})", {"cameras[0].position"});
    check_refused(R"({"cameras": [)" + camera_at(0, 40) + R"(, {"position": [1, 2]}]})",
                  {"cameras[1].position", "3 numbers"});
    check_refused(R"({"cameras": [{"position": [1, 2, 1e300], "look_at": [0,0,0], "up": [0,0,1]}]})",
                  {"position"});
    check_refused(R"({"cameras": [{"position": [0,0,0], "look_at": [0,0,0], "up": [0,0,1]}]})", {"axes"});
    check_refused(R"({"cameras": [{"position": [0,0,0], "look_at": [0,0,5], "up": [0,0,1]}]})", {"axes"});
    check_refused(R"({"cameras": [)" + camera_at(0, 180) + "]}", {"field_of_view", "170"});
    check_refused(R"({"cameras": [)" + camera_at(0, 40) + R"(], "seconds": -1})", {"seconds"});
    check_refused(R"({"cameras": [)" + camera_at(0, 40) + R"(], "width": 1e6, "height": 5})", {"width"});
    check_refused(R"({"camera_path": [{"camera_to_world": [1, 2], "fov": 50}]})",
                  {"camera_path[0].camera_to_world", "16 numbers"});
    check_refused(R"({"camera_path": [{"camera_to_world": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0], "fov": 50}]})",
                  {"axes"});
}
