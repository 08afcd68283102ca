// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "image/mask.hpp"
#include "known_scene.hpp"
#include "readers/colmap/colmap.hpp"
#include "readers/load_scene.hpp"
#include "scene/downsample.hpp"

namespace {

using gs_test::bytes;
using gs_test::error_of;
using gs_test::options_for;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;
using gs_test::write_gray;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// --------------------------------------------------------------------- a model, and COLMAP's two ways to
// write it

struct camera_record {
    std::uint32_t id;
    std::int32_t model_id;
    std::string model;
    std::uint64_t width, height;
    std::vector<double> parameters;
};

struct image_record {
    std::array<double, 4> quaternion;
    std::array<double, 3> translation;
    std::uint32_t camera_id;
    std::string name;
    std::vector<std::array<double, 2>> tracked;
};

struct point_record {
    std::array<double, 3> position;
    std::array<std::uint8_t, 3> color;
    std::uint32_t track_length;
};

struct model_record {
    std::vector<camera_record> cameras;
    std::vector<image_record> images;
    std::vector<point_record> points;
};

std::string cameras_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.cameras.size()});
    for (const auto& c : model.cameras) {
        out.put(c.id).put(c.model_id).put(c.width).put(c.height);
        for (const double parameter : c.parameters) out.put(parameter);
    }
    return out.data();
}

std::string images_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.images.size()});
    std::uint32_t id = 1;
    for (const auto& i : model.images) {
        out.put(id++).put(i.quaternion).put(i.translation).put(i.camera_id).put_text(i.name);
        out.put(std::uint64_t{i.tracked.size()});
        for (const auto& at : i.tracked) out.put(at).put(std::int64_t{-1});
    }
    return out.data();
}

std::string points_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.points.size()});
    std::uint64_t id = 1;
    for (const auto& p : model.points) {
        out.put(id++).put(p.position).put(p.color).put(0.5).put(std::uint64_t{p.track_length});
        for (std::uint32_t i = 0; i < p.track_length; ++i) out.put(i).put(i);
    }
    return out.data();
}

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);  // 17 digits bring back the same double
    return text;
}

template <class Range>
std::string words_of(const Range& values) {
    std::string text;
    for (const double value : values) text += " " + text_of(value);
    return text;
}

std::string cameras_txt(const model_record& model) {
    std::string out = "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, ...\n";
    for (const auto& c : model.cameras)
        out += std::to_string(c.id) + " " + c.model + " " + std::to_string(c.width) + " " +
               std::to_string(c.height) + words_of(c.parameters) + "\n";
    return out;
}

std::string images_txt(const model_record& model) {
    std::string out = "# Image list with two lines of data per image:\n";
    int id = 1;
    for (const auto& i : model.images) {
        out += std::to_string(id++) + words_of(i.quaternion) + words_of(i.translation) + " " +
               std::to_string(i.camera_id) + " " + i.name + "\n";
        for (const auto& at : i.tracked) out += words_of(at) + " -1";
        out += "\n";
    }
    return out;
}

std::string points_txt(const model_record& model) {
    std::string out = "# 3D point list with one line of data per point:\n";
    int id = 1;
    for (const auto& p : model.points) {
        out += std::to_string(id++) + words_of(p.position) + words_of(p.color) + " 0.5";
        for (std::uint32_t i = 0; i < p.track_length; ++i) out += " 1 " + std::to_string(i);
        out += "\n";
    }
    return out;
}

void write_binary(const std::filesystem::path& folder, const model_record& model) {
    write_file(folder / "cameras.bin", cameras_bin(model));
    write_file(folder / "images.bin", images_bin(model));
    write_file(folder / "points3D.bin", points_bin(model));
}

void write_text(const std::filesystem::path& folder, const model_record& model) {
    write_file(folder / "cameras.txt", cameras_txt(model));
    write_file(folder / "images.txt", images_txt(model));
    write_file(folder / "points3D.txt", points_txt(model));
}

/// Two pinhole cameras of which one has two focal lengths, three images out of order, two points.
model_record plain_model() {
    model_record model;
    model.cameras = {{1, 1, "PINHOLE", 40, 30, {50, 35, 19, 16}},
                     {7, 0, "SIMPLE_PINHOLE", 40, 30, {44, 20.5, 14}}};
    model.images = {
        {{0.5, -0.1, 0.7, 0.2}, {0.25, -1, 3}, 7, "c.png", {}},
        {{1, 0, 0, 0}, {0, 0, 0}, 1, "a.png", {{1.5, 2.5}, {3.25, 4}}},
        {{std::sqrt(0.5), 0, 0, -std::sqrt(0.5)}, {1, 2, 3}, 1, "b.png", {}},
    };
    model.points = {{{1, 2, 3}, {10, 20, 30}, 2}, {{-1, 0.1, 5e-3}, {0, 255, 128}, 0}};
    return model;
}

/// Images of one place by one camera, and one point.
model_record photos_by(const camera_record& camera, const std::vector<std::string>& names) {
    model_record model;
    model.cameras = {camera};
    for (const std::string& name : names) model.images.push_back({{1, 0, 0, 0}, {0, 0, 0}, 1, name, {}});
    model.points = {{{0, 0, 1}, {1, 2, 3}, 0}};
    return model;
}

void write_photo(const std::filesystem::path& file, int width, int height) {
    std::filesystem::create_directories(file.parent_path());
    std::vector<float> planes(static_cast<std::size_t>(3 * width * height), 0.5F);
    gs::write_png(file, width, height, planes);
}

void write_photos(const std::filesystem::path& folder, const model_record& model, int width, int height) {
    for (const auto& i : model.images) write_photo(folder / i.name, width, height);
}

/// A whole scene of the plain model in binary files.
void write_scene(const std::filesystem::path& folder) {
    write_binary(folder / "sparse/0", plain_model());
    write_photos(folder / "images", plain_model(), 40, 30);
}

void ignore(const std::string&) {}

std::string error_of_loading(const gs::load_options& options) {
    return error_of([&] { gs::load_scene(options, ignore); });
}

std::string error_of_loading(const std::filesystem::path& folder) {
    return error_of_loading(options_for(folder));
}

bool same(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    return glm::distance(a, b) <= tolerance;
}

glm::dvec2 project(const gs::camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = camera.rotation * point + camera.translation;
    return {camera.fx * p.x / p.z + camera.cx, camera.fy * p.y / p.z + camera.cy};
}

constexpr double rounding = 1e-12;  // some operations on doubles of about 1 to 100

// ----------------------------------------------------------------------------------------- lenses, once more

struct distorted_case {
    camera_record camera;
    std::function<glm::dvec2(glm::dvec2)> distort;  ///< written down again from COLMAP's documentation
};

distorted_case simple_radial(double k) {
    return {{1, 2, "SIMPLE_RADIAL", 160, 120, {130, 83, 57, k}},
            [k](glm::dvec2 p) { return p * (1 + k * glm::dot(p, p)); }};
}

distorted_case radial(double k1, double k2) {
    return {{1, 3, "RADIAL", 160, 120, {130, 83, 57, k1, k2}}, [k1, k2](glm::dvec2 p) {
                const double r2 = glm::dot(p, p);
                return p * (1 + k1 * r2 + k2 * r2 * r2);
            }};
}

distorted_case opencv(double k1, double k2, double p1, double p2) {
    return {{1, 4, "OPENCV", 160, 120, {130, 110, 83, 57, k1, k2, p1, p2}}, [=](glm::dvec2 p) {
                const double r2 = glm::dot(p, p), xy = p.x * p.y;
                const glm::dvec2 tangential(2 * p1 * xy + p2 * (r2 + 2 * p.x * p.x),
                                            p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * xy);
                return p * (1 + k1 * r2 + k2 * r2 * r2) + tangential;
            }};
}

/// The ray that is bent to `bent`: a fixed point of small steps.
glm::dvec2 undistorted(const distorted_case& lens, glm::dvec2 bent) {
    glm::dvec2 ray = bent;
    for (int i = 0; i < 200; ++i) ray -= 0.7 * (lens.distort(ray) - bent);
    return ray;
}

/// The image painted on the rays, from 0 to 255.
double painted(glm::dvec2 ray) { return 127 + 60 * std::sin(3 * ray.x) + 50 * std::cos(4 * ray.y + 1); }

gs::camera intrinsics_of(const camera_record& record) {
    const auto& p = record.parameters;
    gs::camera result;
    result.width = static_cast<int>(record.width);
    result.height = static_cast<int>(record.height);
    const bool two = record.model == "OPENCV";
    result.fx = p[0];
    result.fy = p[two ? 1 : 0];
    result.cx = p[two ? 2 : 1];
    result.cy = p[two ? 3 : 2];
    return result;
}

void write_distorted_photo(const std::filesystem::path& file, const distorted_case& lens) {
    const gs::camera c = intrinsics_of(lens.camera);
    std::vector<float> planes;
    for (int plane = 0; plane < 3; ++plane)
        for (int y = 0; y < c.height; ++y)
            for (int x = 0; x < c.width; ++x) {
                const glm::dvec2 ray = undistorted(lens, {(x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy});
                planes.push_back(static_cast<float>(painted(ray) / 255));
            }
    std::filesystem::create_directories(file.parent_path());
    gs::write_png(file, c.width, c.height, planes);
}

/// How far the straight camera's border stays from the photo's, in pixels of the photo; negative beyond it.
double least_margin(const distorted_case& lens, const gs::camera& straight) {
    const gs::camera c = intrinsics_of(lens.camera);
    double least = infinity;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const glm::dvec2 bent =
                lens.distort({(x + 0.5 - straight.cx) / straight.fx, (y + 0.5 - straight.cy) / straight.fy});
            const glm::dvec2 at(c.fx * bent.x + c.cx - 0.5, c.fy * bent.y + c.cy - 0.5);
            least = std::min({least, at.x, at.y, c.width - 1 - at.x, c.height - 1 - at.y});
        }
    return least;
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
        CHECK(a.model == written.cameras[i].model);
        CHECK(b.model == written.cameras[i].model);
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
        write_distorted_photo(folder / "images/b.png", lens);
        std::vector<std::string> said;
        const gs::scene scene = gs::load_scene(options_for(folder.path()),
                                               [&](const std::string& line) { said.push_back(line); });
        REQUIRE(said.size() == 1);
        CHECK(says(said[0], {"1 camera ", lens.camera.model, "pinhole"}));

        const gs::camera was = intrinsics_of(lens.camera);
        for (const gs::view& view : scene.train) {
            const gs::camera& is = view.camera;
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
    // r (1 - 0.3 r^2) grows up to r = 1.054 only; the photo's corners, at 1.25, still hold what lies farther
    // out.
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

TEST_CASE("the resolution scales photos and intrinsics by the same exact ratios") {
    const temporary_folder folder;
    model_record model = plain_model();
    model.cameras = {{1, 1, "PINHOLE", 101, 67, {120, 90, 49, 35}}};
    for (auto& i : model.images) i.camera_id = 1;
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 101, 67);
    const gs::scene full = gs::load_scene(options_for(folder.path()), ignore);
    struct expected {
        int resolution, width, height;
    };
    for (const expected& one : {expected{1, 101, 67},
                                {2, 51, 34},
                                {4, 25, 17},
                                {8, 13, 8},
                                {50, 50, 33},
                                {100, 100, 66},
                                {3, 3, 2},
                                {101, 101, 67},
                                {400, 101, 67}}) {
        const int resolution = one.resolution, width = one.width, height = one.height;
        CAPTURE(resolution);
        auto options = options_for(folder.path());
        options.resolution = resolution;
        std::string said;
        const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
        for (std::size_t i = 0; i < scene.train.size(); ++i) {
            const gs::camera& c = scene.train[i].camera;
            REQUIRE(c.width == width);
            REQUIRE(c.height == height);
            CHECK(scene.train[i].pixels.width == width);
            CHECK(scene.train[i].pixels.height == height);
            CHECK(c.fx == doctest::Approx(120.0 * width / 101).epsilon(rounding));
            CHECK(c.fy == doctest::Approx(90.0 * height / 67).epsilon(rounding));
            const glm::dvec3 point = glm::transpose(c.rotation) * (glm::dvec3(0.3, -0.2, 2) - c.translation);
            const glm::dvec2 at = project(c, point), was = project(full.train[i].camera, point);
            CHECK(at.x / width == doctest::Approx(was.x / 101).epsilon(rounding));
            CHECK(at.y / height == doctest::Approx(was.y / 67).epsilon(rounding));
        }
        if (resolution == 1 || resolution == 101)
            CHECK(said.empty());
        else if (resolution == 400)
            CHECK(says(said, {"3 photos left as they are", "400"}));
        else
            CHECK(says(said,
                       {"3 photos resized", "101x67", std::to_string(width) + "x" + std::to_string(height)}));
    }
    auto options = options_for(folder.path());
    options.resolution = 0;
    CHECK(says(error_of_loading(options), {"resolution", "at least 1"}));
}

TEST_CASE("a photo is never downsampled below one pixel") {
    const temporary_folder folder;
    model_record model = plain_model();
    for (auto& c : model.cameras) c.width = 40, c.height = 2;
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 2);
    auto options = options_for(folder.path());
    options.resolution = 8;
    const gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train[0].pixels.width == 5);
    CHECK(scene.train[0].pixels.height == 1);
}

TEST_CASE("smaller copies of the photos take their cameras along, and other sizes are wrong") {
    const temporary_folder folder;
    write_scene(folder.path());
    write_photos(folder / "images_2", plain_model(), 20, 15);
    auto options = options_for(folder.path());
    options.images = "images_2";
    std::string said;
    const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
    const gs::camera& c = scene.train[0].camera;
    CHECK(std::array{c.fx, c.fy, c.cx, c.cy} == std::array{25.0, 17.5, 9.5, 8.0});
    CHECK(std::pair{c.width, c.height} == std::pair{20, 15});
    CHECK(says(said, {"3 photos", "40x30", "20x15", "scaled"}));

    write_photos(folder / "images_3", plain_model(), 400, 300);
    options.images = "images_3";
    write_photo(folder / "images_3/b.png", 400, 304);  // 1.3 % off
    CHECK(says(error_of_loading(options), {"b.png", "wrong size", "400x304", "40x30"}));
    write_photo(folder / "images_3/b.png", 400, 302);  // 0.7 % off
    CHECK(error_of_loading(options).empty());
    write_photo(folder / "images_3/b.png", 200, 150);  // a smaller copy, but the only one
    CHECK(says(error_of_loading(options), {"b.png", "wrong size", "200x150", "40x30"}));
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

TEST_CASE("masks exclude black pixels, also in undistorted and downsampled photos") {
    for (const double bent : {0.0, 0.1}) {
        CAPTURE(bent);
        const distorted_case lens = radial(-bent, bent / 2);
        const gs::camera c = intrinsics_of(lens.camera);
        const temporary_folder folder;
        write_binary(folder / "sparse/0", photos_by(lens.camera, {"a.png", "b/c.png", "d.png"}));
        // Photos are red where the mask is black, and blue otherwise; the masks are 1 of 255 where they are
        // not black.
        const auto write = [&](const std::filesystem::path& file, const std::array<float, 3>& left_out,
                               const std::array<float, 3>& kept) {
            std::filesystem::create_directories(file.parent_path());
            std::vector<float> planes;
            for (std::size_t plane = 0; plane < 3; ++plane)
                for (int y = 0; y < c.height; ++y)
                    for (int x = 0; x < c.width; ++x)
                        planes.push_back((x < c.width / 3 ? left_out : kept)[plane]);
            gs::write_png(file, c.width, c.height, planes);
        };
        for (const char* name : {"images/a.png", "images/b/c.png", "images/d.png"})
            write(folder / name, {1, 0, 0}, {0, 0, 1});
        for (const char* name : {"masks/a.png.png", "masks/b/c.png"})
            write(folder / name, {0, 0, 0}, {0, 1.0f / 255, 0});
        auto options = options_for(folder.path());
        for (const int resolution : {1, 2, 4}) {
            CAPTURE(resolution);
            options.resolution = resolution;
            options.masks = true;
            std::string said;
            const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
            CHECK(says(said, {"2 photos of 3 have masks"}));
            CHECK_FALSE(scene.has_alpha);
            options.masks = false;
            const gs::scene whole = gs::load_scene(options, ignore);
            for (std::size_t v = 0; v < 3; ++v) {
                const gs::image &pixels = scene.train[v].pixels, &all = whole.train[v].pixels;
                CHECK(pixels.has_mask == (v < 2));
                CHECK_FALSE(all.has_mask);
                for (std::size_t i = 0; i < all.rgba.size() / 4; ++i) {
                    const int red = all.rgba[4 * i];
                    if (v < 2 && red > 200) CHECK(pixels.is_masked(i));
                    if (v == 2 || red < 60) CHECK_FALSE(pixels.is_masked(i));
                    // What is left out comes into no average, but into what bending interpolates.
                    if (v < 2 && !pixels.is_masked(i)) CHECK(pixels.rgba[4 * i] <= (bent > 0 ? 128 : 0));
                }
            }
        }
        options.masks = true;
        options.resolution = 1;
        write(folder / "masks/a.png.png", {0, 0, 0}, {0, 0, 0});
        CHECK(says(error_of_loading(options), {"a.png.png", "leaves nothing"}));
        write_photo(folder / "masks/a.png.png", 30, 22);
        CHECK(says(error_of_loading(options), {"a.png.png", "wrong size", "30x22"}));
        write_file(folder / "masks/a.png.png", "no mask");
        CHECK(says(error_of_loading(options), {"a.png.png"}));
    }
}

TEST_CASE("depth maps are undistorted and downsampled with their photos, and some photos have none") {
    for (const double bent : {0.0, 0.1}) {
        CAPTURE(bent);
        const distorted_case lens = radial(-bent, bent / 2);
        const gs::camera c = intrinsics_of(lens.camera);
        const temporary_folder folder;
        write_binary(folder / "sparse/0", photos_by(lens.camera, {"a.jpg", "b.png", "c.png"}));
        // Bright above, dark below, not known at the left; photos are as the maps.
        const auto write = [&](int width, int height) {
            std::vector<std::uint16_t> values;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    values.push_back(4 * x < width ? 0 : 2 * y < height ? 60000 : 257);
            write_gray(folder / "depths/a.png", width, height, values);
        };
        for (const char* name : {"a.jpg", "b.png", "c.png"}) {
            std::vector<float> planes;
            for (int plane = 0; plane < 3; ++plane)
                for (int y = 0; y < c.height; ++y)
                    for (int x = 0; x < c.width; ++x) planes.push_back(2 * y < c.height ? 1.0f : 0.0f);
            std::filesystem::create_directories(folder / "images");
            gs::write_png(folder / "images" / name, c.width, c.height, planes);
        }
        auto options = options_for(folder.path());
        for (const int smaller : {1, 3})
            for (const int resolution : {1, 2, 4}) {
                CAPTURE(smaller);
                CAPTURE(resolution);
                write(c.width / smaller, c.height / smaller);
                options.resolution = resolution;
                std::string said;
                const gs::scene scene =
                    gs::load_scene(options, [&](const std::string& line) { said += line; });
                CHECK(says(said, {"1 photo of 3 has a depth map"}));
                const gs::view& first = scene.train[0];
                REQUIRE(first.depths.is_there());
                CHECK_FALSE(scene.train[1].depths.is_there());
                CHECK(first.depths.width == first.pixels.width);
                REQUIRE(first.depths.values.size() == first.pixels.rgba.size() / 4);
                std::size_t wrong = 0, known = 0;
                for (std::size_t i = 0; i < first.depths.values.size(); ++i) {
                    const int value = first.depths.values[i], gray = first.pixels.rgba[4 * i];
                    known += value != 0;
                    if (value != 0 && (gray == 0 || gray == 255)) wrong += (value > 30000) != (gray > 127);
                }
                CHECK(wrong <= first.depths.values.size() / 20);  // where a map is coarser than its photo
                CHECK(static_cast<double>(known) / static_cast<double>(first.depths.values.size()) ==
                      doctest::Approx(0.75).epsilon(0.1));
                const gs::view half = gs::downsampled(first, 2);
                CHECK(half.depths.width == half.pixels.width);
                CHECK(half.depths.values.size() == half.pixels.rgba.size() / 4);
            }
        options.resolution = 1;
        options.depths = false;
        CHECK_FALSE(gs::load_scene(options, ignore).train[0].depths.is_there());
        options.depths = true;
        write(c.width, c.height / 2);
        CHECK(says(error_of_loading(options), {"depths/a.png", "another shape"}));
        gs::write_png(folder / "depths/a.png", 1, 1, {0, 0, 0});
        CHECK(says(error_of_loading(options), {"depths/a.png", "more than one channel"}));
        write_file(folder / "depths/a.png", "no map");
        CHECK(says(error_of_loading(options), {"depths/a.png"}));
    }
}

TEST_CASE("a mask leaves out of a depth map what it leaves out of its photo") {
    gs::image photo{2, 1, {9, 9, 9, 255, 9, 9, 9, 255}};
    photo.mask_pixel(1);
    gs::depth_map depths{2, 1, {7, 8}}, none;
    gs::clear_masked_depths(photo, depths);
    gs::clear_masked_depths(photo, none);
    CHECK(depths.values == std::vector<std::uint16_t>{7, 0});
    CHECK_FALSE(none.is_there());
}

TEST_CASE("a mask has its photo's name, in its own folder") {
    const temporary_folder folder;
    const auto masks = folder / "masks";
    for (const char* name : {"masks/x.jpg.png", "masks/x.png", "masks/sub/y.png", "images/z.png"}) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_file(folder / name, "");
    }
    CHECK(gs::beside_photo(masks, "x.jpg") == masks / "x.jpg.png");
    CHECK(gs::beside_photo(masks, "x.JPG") == masks / "x.png");
    CHECK(gs::beside_photo(masks, "sub/y.jpeg") == masks / "sub/y.png");
    CHECK(gs::beside_photo(masks, "y.jpeg").empty());
    CHECK(gs::beside_photo(masks, "").empty());
    CHECK(gs::beside_photo(masks, "../images/z.png").empty());
    CHECK(gs::beside_photo(masks, (folder / "images/z.png").string()).empty());
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

TEST_CASE("synthetic:NAME is made, not read") {
    gs::load_options options;
    options.data = "synthetic:spheres";
    options.resolution = 16;
    options.eval = true;
    const gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train.size() == 40);
    CHECK(scene.test.size() == 8);
    CHECK(scene.train[0].pixels.width == 16);
    options.data = "synthetic:nothing";
    CHECK(says(error_of_loading(options), {"nothing"}));
    options.data = "synthetic:spheres";
    options.resolution = -1;
    CHECK(says(error_of_loading(options), {"resolution", "-1"}));
}

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
