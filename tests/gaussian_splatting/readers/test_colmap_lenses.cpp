// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "known_lenses.hpp"
#include "readers/colmap/colmap.hpp"

namespace {

using namespace gs_test;

/// The ray that is bent to `bent`: a fixed point of small steps.
glm::dvec2 undistorted(const distorted_case& lens, glm::dvec2 bent) {
    glm::dvec2 ray = bent;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 miss = lens.distort(ray) - bent;
        ray -= 0.7 * miss;
        if (glm::length(miss) < 1e-12) break;
    }
    return ray;
}

/// The image painted on the rays, from 0 to 255.
double painted(glm::dvec2 ray) { return 127 + 60 * std::sin(3 * ray.x) + 50 * std::cos(4 * ray.y + 1); }

void write_distorted_photo(const std::filesystem::path& file, const distorted_case& lens) {
    const gs::camera c = intrinsics_of(lens.camera);
    std::vector<float> plane;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const glm::dvec2 ray = undistorted(lens, {(x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy});
            plane.push_back(static_cast<float>(painted(ray) / 255));
        }
    std::vector<float> planes = plane;
    for (int more = 0; more < 2; ++more) planes.insert(planes.end(), plane.begin(), plane.end());
    std::filesystem::create_directories(file.parent_path());
    gs::write_png(file, c.width, c.height, planes);
}

/// How far the straight camera's border stays from the photo's, in pixels of the photo; negative beyond it.
double least_margin(const distorted_case& lens, const gs::camera& straight) {
    const gs::camera c = intrinsics_of(lens.camera);
    double least = std::numeric_limits<double>::infinity();
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const glm::dvec2 bent =
                lens.distort({(x + 0.5 - straight.cx) / straight.fx, (y + 0.5 - straight.cy) / straight.fy});
            const glm::dvec2 at(c.fx * bent.x + c.cx - 0.5, c.fy * bent.y + c.cy - 0.5);
            least = std::min({least, at.x, at.y, c.width - 1 - at.x, c.height - 1 - at.y});
        }
    return least;
}

}  // namespace

TEST_CASE("photos of a lens with distortion become those of a pinhole camera") {
    const distorted_case lenses[] = {simple_radial(0.15),
                                     simple_radial(-0.12),
                                     radial(-0.1, 0.05),
                                     radial(0.08, -0.03),
                                     opencv(-0.09, 0.02, 4e-3, -6e-3),
                                     opencv(0.1, 0.02, -5e-3, 3e-3),
                                     opencv(0, 0, 0.01, 0)};
    for (const distorted_case& lens : lenses) {
        CAPTURE(lens.camera.model);
        CAPTURE(lens.camera.parameters.back());
        const temporary_folder folder;
        model_record model;
        model.cameras = {lens.camera};
        model.images = {{{1, 0, 0, 0}, {0, 0, 0}, 1, "a.png", {}}, {{1, 0, 0, 0}, {1, 0, 0}, 1, "b.png", {}}};
        model.points = {{{0, 0, 1}, {1, 2, 3}, 0}};
        write_binary(folder / "sparse/0", model);
        write_distorted_photo(folder / "images/a.png", lens);
        std::filesystem::copy(folder / "images/a.png", folder / "images/b.png");
        std::vector<std::string> said;
        const gs::scene scene = gs::load_scene(options_for(folder.path()),
                                               [&](const std::string& line) { said.push_back(line); });
        REQUIRE(said.size() == 1);
        CHECK(says(said[0], {"1 camera ", lens.camera.model, "pinhole"}));

        const gs::camera was = intrinsics_of(lens.camera);
        for (const gs::view& view : scene.train) {
            const gs::camera& is = view.camera;
            CHECK(glm::distance(view.removed_distortion.distort({0.3, -0.2}), lens.distort({0.3, -0.2})) <
                  1e-12);
            REQUIRE(std::pair{is.width, is.height} == std::pair{was.width, was.height});
            CHECK(std::pair{is.cx, is.cy} == std::pair{was.cx, was.cy});
            CHECK(is.fx / was.fx == doctest::Approx(is.fy / was.fy).epsilon(rounding));
            // No pixel from outside, yet the border is reached. The border is sampled every 2.5 pixels or
            // less, and where it is not it bulges by less than a thousandth of a pixel.
            const double margin = least_margin(lens, is);
            CHECK(margin > -1e-3);
            CHECK(margin < 1e-3);
            double worst = 0;
            for (int y = 0; y < is.height; ++y)
                for (int x = 0; x < is.width; ++x) {
                    const double value = view.pixels.rgba[4 * static_cast<std::size_t>(y * is.width + x)];
                    const glm::dvec2 ray((x + 0.5 - is.cx) / is.fx, (y + 0.5 - is.cy) / is.fy);
                    worst = std::max(worst, std::abs(value - painted(ray)));
                }
            // Two roundings to 8 bits, each up to 0.5, and h^2/8 of the image's curvature, up to 16 * 50 a
            // square of the ray, for pixels of h = 1/110: another 0.01 along each axis.
            CHECK(worst < 1.05);
        }
    }
}

TEST_CASE("barrel distortion lets the pinhole camera see wider, pincushion narrower") {
    for (const double k : {-0.12, 0.15}) {
        const auto lens = simple_radial(k);
        const auto straight = gs::undistorted_camera(intrinsics_of(lens.camera), {k, 0, 0, 0});
        REQUIRE(straight);
        CHECK((straight->fx < lens.camera.parameters[0]) == (k < 0));
    }
}

TEST_CASE("the area scale of a lens is the determinant of its derivative") {
    const gs::lens lens{0.3, -0.2, 0.04, -0.06};
    const double step = 1e-4;
    for (const glm::dvec2 ray : {glm::dvec2(0, 0), {0.7, 0.2}, {-0.4, 0.9}, {1.2, -0.8}, {-0.5, -0.6}}) {
        const glm::dvec2 x(step, 0), y(0, step);
        const glm::dvec2 by_x = (lens.distort(ray + x) - lens.distort(ray - x)) / (2 * step);
        const glm::dvec2 by_y = (lens.distort(ray + y) - lens.distort(ray - y)) / (2 * step);
        // Central differences are off by step^2 times third derivatives, which are below 100 here, and in the
        // determinant each meets another first derivative, below 10.
        CHECK(std::abs(lens.area_scale(ray) - (by_x.x * by_y.y - by_x.y * by_y.x)) < 100 * 10 * step * step);
    }
}

TEST_CASE("what a strong lens folds over stays outside of the pinhole camera's view") {
    // r (1 - 0.3 r^2) grows up to r = 1.054 only; the photo's corners, at 1.25, still show points
    // farther out.
    const gs::lens lens{-0.3, 0, 0, 0};
    gs::camera camera;
    camera.width = 400;
    camera.height = 300;
    camera.fx = camera.fy = 200;
    camera.cx = 200;
    camera.cy = 150;
    const auto straight = gs::undistorted_camera(camera, lens);
    REQUIRE(straight);
    const double corner = std::hypot(199.5, 149.5) / straight->fx, fold = 1 / std::sqrt(3 * 0.3);
    CHECK(corner < fold);
    CHECK(corner > 0.999 * fold);  // all of the rest is seen
}

TEST_CASE("a lens whose coefficients are zero leaves the photo alone") {
    const temporary_folder folder;
    model_record model = plain_model();
    model.cameras = {{1, 4, "OPENCV", 40, 30, {50, 35, 19, 16, 0, 0, 0, 0}},
                     {7, 2, "SIMPLE_RADIAL", 40, 30, {44, 20, 15, 0}}};
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 30);
    int lines = 0;
    const gs::scene scene = gs::load_scene(options_for(folder.path()), [&](const std::string&) { ++lines; });
    CHECK(lines == 0);
    CHECK(scene.train[0].camera.fx == 50);
    CHECK(scene.train[0].camera.fy == 35);
}

TEST_CASE("a lens that folds the photo over is refused") {
    const temporary_folder folder;
    model_record model = plain_model();
    for (auto& c : model.cameras) c = {c.id, 2, "SIMPLE_RADIAL", 40, 30, {1, 20, 15, -0.3}};
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 30);
    CHECK(says(error_of_loading(folder.path()), {"a.png", "distorts too strongly"}));
}

TEST_CASE("a lens whose image overflows is sampled within the photo") {
    gs::camera camera;
    camera.width = camera.height = 4;
    camera.fx = camera.fy = 1e-200;
    gs::image photo;
    photo.width = photo.height = 4;
    photo.rgba.assign(4 * 4 * 4, 200);
    const gs::image bent = gs::undistort(photo, camera, {1, -1, 0, 0}, camera);  // inf - inf
    CHECK(bent.rgba == photo.rgba);
}

TEST_CASE("photos of fisheye lenses stay as they are, in binary and in text") {
    for (const bool is_text : {false, true}) {
        CAPTURE(is_text);
        const temporary_folder folder;
        model_record model = plain_model();
        model.cameras = {{1, 5, "OPENCV_FISHEYE", 40, 30, {12, 11, 19, 16, 0.1, -0.02, 0.003, -0.0004}},
                         {2, 8, "SIMPLE_RADIAL_FISHEYE", 40, 30, {12, 19, 16, 0.1}},
                         {7, 9, "RADIAL_FISHEYE", 40, 30, {12, 19, 16, 0.1, -0.02}}};
        model.images[2].camera_id = 2;
        (is_text ? write_text : write_binary)(folder / "sparse/0", model);
        write_photos(folder / "images", model, 40, 30);
        std::string said;
        auto options = options_for(folder.path());
        const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
        CHECK_FALSE(says(said, {"pinhole"}));
        const auto k = [&](std::size_t view) { return scene.train[view].camera.fisheye.value().k(); };
        CHECK(k(0) == std::array{0.1, -0.02, 0.003, -0.0004});
        CHECK(k(1) == std::array{0.1, 0.0, 0.0, 0.0});
        CHECK(k(2) == std::array{0.1, -0.02, 0.0, 0.0});
        CHECK(scene.train[0].camera.fx == 12);
        CHECK(scene.train[0].camera.fy == 11);
        CHECK(scene.train[1].camera.fy == 12);
        options.resolution = 2;
        const gs::camera half = gs::load_scene(options, ignore).train[0].camera;
        CHECK(half.fx == 6);
        CHECK(half.fisheye.value().k() == k(0));
    }
}
