// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "features/feature.hpp"
#include "features/sh_degree/direction.hpp"
#include "features/sky/sky_fit.hpp"
#include "readers/load_scene.hpp"
#include "scene/scene_statistics.hpp"

namespace {

using namespace gs::features;

gs::scene explained_scene(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    return gs::load_scene(o, {});
}

explanation explained(std::string_view name, const gs::scene& scene) {
    const gs::scene_statistics statistics(scene);
    for (const auto& f : all_features())
        if (f->name() == name) return f->explain(statistics, f->analyze(statistics));
    FAIL("there is no feature " << name);
    return {};
}

const gs::pages::marked_photo& photo_labelled(const explanation& from, std::string_view label) {
    const auto found = std::ranges::find(from.photos, label, &gs::pages::marked_photo::label);
    REQUIRE(found != from.photos.end());
    return *found;
}

std::size_t view_called(const gs::scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.train, name, &gs::view::name);
    REQUIRE(found != scene.train.end());
    return static_cast<std::size_t>(found - scene.train.begin());
}

bool covers(const std::vector<gs::pages::mark>& marks, double x, double y, int color) {
    return std::ranges::any_of(marks, [&](const gs::pages::mark& m) {
        return m.color == color && x >= m.left && x < m.left + m.width && y >= m.top && y < m.top + m.height;
    });
}

}  // namespace

TEST_CASE("explain: each effect names its condition, and shows photos of the scene's size") {
    const gs::scene scene = explained_scene("spheres,sky=0.7,exposure=0.3,gloss=0.6,passers=0.1,depths=0.05");
    const gs::scene_statistics statistics(scene);
    for (const auto& f : all_features()) {
        CAPTURE(f->name());
        const explanation found = f->explain(statistics, f->analyze(statistics));
        CHECK(!found.condition.empty());
        if (f->name() == "background") continue;  // all photos are opaque
        CHECK(!found.charts.empty());
        REQUIRE(!found.photos.empty());
        for (const gs::pages::marked_photo& photo : found.photos) {
            CHECK(photo.pixels.rgba.size() == 4 * static_cast<std::size_t>(photo.pixels.width) *
                                                  static_cast<std::size_t>(photo.pixels.height));
            CHECK(std::ranges::all_of(photo.marks, [&](const gs::pages::mark& m) {
                return m.left >= 0 && m.top >= 0 && m.left + m.width <= photo.width &&
                       m.top + m.height <= photo.height;
            }));
            if (photo.name.empty()) continue;
            CHECK(photo.width == scene.train[view_called(scene, photo.name)].camera.width);
        }
    }
}

TEST_CASE("explain: a scene without points has no photos of effects that need points") {
    gs::scene scene = explained_scene("spheres,views=3,points=300");
    scene.points.clear();
    for (const char* name : {"direction", "vignetting", "exposure", "response", "antialiasing", "sky",
                             "poses", "moving", "masks", "depth"}) {
        CAPTURE(name);
        const explanation found = explained(name, scene);
        CHECK(!found.condition.empty());
        CHECK(found.charts.empty());
        CHECK(found.photos.empty());
    }
}

TEST_CASE("explain: exposure shows the darkest and the brightest photo, and each one in a chart") {
    const gs::scene scene = explained_scene("spheres,exposure=0.5");
    const explanation found = explained("exposure", scene);
    const gs::scene_statistics statistics(scene);
    const std::vector<double>& log2 = statistics.brightness().log2;
    const std::size_t darkest = view_called(scene, photo_labelled(found, "Darkest photo").name),
                      brightest = view_called(scene, photo_labelled(found, "Brightest photo").name);
    CHECK(log2[darkest] == std::ranges::min(log2));
    CHECK(log2[brightest] == std::ranges::max(log2));
    REQUIRE(found.charts.size() == 1);
    const auto& points = found.charts[0].curves[0].points;
    REQUIRE(points.size() == scene.train.size());
    CHECK(points[darkest].first == static_cast<double>(darkest + 1));
    CHECK(points[darkest].second == doctest::Approx(100 * (std::exp2(log2[darkest]) - 1)));
    CHECK(found.condition.find("3.9 %") != std::string::npos);
}

TEST_CASE("explain: sky is marked where it is") {
    const gs::scene scene = explained_scene("spheres,sky=0.8");
    const explanation found = explained("sky", scene);
    const gs::pages::marked_photo& most = photo_labelled(found, "Most sky");
    CHECK(covers(most.marks, 2, 2, 0));
    CHECK_FALSE(covers(most.marks, most.width / 2.0, most.height / 2.0, 0));
    const auto area = [](const gs::pages::marked_photo& photo) {
        double sum = 0;
        for (const gs::pages::mark& m : photo.marks)
            if (m.color == 0) sum += m.width * m.height;
        return sum;
    };
    CHECK(area(most) > area(photo_labelled(found, "Least sky")));
    const std::vector<photo_cells> cells = divide_photos(scene);
    const std::size_t view = view_called(scene, most.name);
    const double of_fit = static_cast<double>(fit_sky(scene, cells, {}).predicted[view].size()) *
                          cells[view].side * cells[view].side;
    CHECK(area(most) == doctest::Approx(of_fit));
    REQUIRE(found.charts.size() == 1);
    CHECK(found.charts[0].curves[0].points[view].second ==
          doctest::Approx(100 * of_fit / (most.width * most.height)));
}

TEST_CASE("explain: rings mark the points that a moving thing hides") {
    const gs::scene scene = explained_scene("spheres,moving=0.1");
    const gs::scene static_scene = explained_scene("spheres");
    const explanation found = explained("moving", scene);
    const gs::pages::marked_photo& most = photo_labelled(found, "Most hidden points");
    const std::size_t view = view_called(scene, most.name);
    const gs::image &with = scene.train[view].pixels, &without = static_scene.train[view].pixels;
    REQUIRE(most.marks.size() >= 10);
    const auto differs = [&](int x, int y) {
        const auto i = 4 * static_cast<std::size_t>(y * with.width + x);
        return !std::equal(&with.rgba[i], &with.rgba[i] + 3, &without.rgba[i]);
    };
    for (const gs::pages::mark& m : most.marks) {
        int differing = 0;  // of the pixels whose mean is compared
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                differing += differs(static_cast<int>(m.left) + dx, static_cast<int>(m.top) + dy) ? 1 : 0;
        CHECK(differing > 0);
    }
    const auto& shares = found.charts.at(0).curves.at(0).points;
    CHECK(shares.size() == scene.train.size());
    CHECK(shares[view].second > 8);
}

TEST_CASE("explain: the gain of a degree is the mean of the gains at points") {
    const gs::scene scene = explained_scene("spheres,gloss=0.6");
    const gs::observed_points points = comparable_points(gs::scene_statistics(scene));
    const auto unexplained = unexplained_by_direction(points);
    for (const int degree : {1, 3}) {
        const std::vector<double> gains = explained_by_direction(points, degree);
        REQUIRE(gains.size() == points.size());
        double sum = 0, count = 0;
        for (std::size_t p = 0; p < points.size(); ++p) {
            sum += gains[p] * static_cast<double>(points[p].size());
            count += static_cast<double>(points[p].size());
        }
        CHECK(sum / count == doctest::Approx(unexplained[0] - unexplained[static_cast<std::size_t>(degree)]));
    }
}

TEST_CASE("explain: direction marks glossy points, and lists the same point in several photos") {
    const gs::scene scene = explained_scene("spheres,gloss=0.6");
    const explanation found = explained("direction", scene);
    const gs::pages::marked_photo& marked =
        photo_labelled(found, "Where color varies most with the direction");
    CHECK(marked.marks.size() > 5);
    CHECK(std::ranges::count(marked.marks, 1, &gs::pages::mark::color) <= 6);
    const gs::camera& camera = scene.train[view_called(scene, marked.name)].camera;
    for (const gs::pages::mark& m : marked.marks)
        CHECK(std::ranges::any_of(scene.points, [&](const gs::colored_point& p) {
            const auto place = camera.see(p.position);
            return place && std::hypot(place->x - m.left, place->y - m.top) < 1e-9;
        }));
    const gs::image& sheet = photo_labelled(found, "The same point in several photos").pixels;
    // The first color of a row is the brightest one, and the second swatch shows that more clearly.
    const auto swatch = [&](int row, int column, int which) {
        const auto i =
            static_cast<std::size_t>((row * 92 + 70 + 12 * which) * sheet.width + column * 68 + 32);
        return int{sheet.rgba[4 * i]} + sheet.rgba[4 * i + 1] + sheet.rgba[4 * i + 2];
    };
    CHECK(sheet.height >= 88);
    for (int row = 0; row < (sheet.height + 4) / 92; ++row)
        for (int column = 1; column < 5; ++column) {
            CAPTURE(row);
            CAPTURE(column);
            CHECK(swatch(row, 0, 0) >= swatch(row, column, 0));
            CHECK(swatch(row, 0, 1) - swatch(row, 4, 1) > 2 * (swatch(row, 0, 0) - swatch(row, 4, 0)));
        }
    CHECK(std::ranges::count(found.options, "--sh-degree 0") == 1);
    CHECK(found.options.size() == 3);
}

TEST_CASE("explain: antialiasing shows a point from near and from far") {
    const gs::scene scene = explained_scene("spheres,scales=4");
    const explanation found = explained("antialiasing", scene);
    const auto distance_of = [&](const char* label) {
        return glm::length(
            scene.train[view_called(scene, photo_labelled(found, label).name)].camera.center());
    };
    CHECK(distance_of("Far view") > 1.5 * distance_of("Near view"));
    CHECK(photo_labelled(found, "Far view").marks.size() == 1);
    // The share of points above the threshold decides.
    const auto share_above = [](const explanation& of, double ratio) {
        const auto& points = of.charts.at(0).curves.at(0).points;
        const auto above = std::ranges::find_if(points, [&](const auto& p) { return p.first >= ratio; });
        return above == points.end() ? 0.0 : above->second;
    };
    CHECK(share_above(found, 2) > 50);
    CHECK(share_above(explained("antialiasing", explained_scene("spheres")), 2) < 50);
}

TEST_CASE("explain: masks appear as stripes") {
    const gs::scene scene = explained_scene("spheres,passers=0.2,views=8,points=300");
    const explanation found = explained("masks", scene);
    const gs::pages::marked_photo& most = photo_labelled(found, "Largest mask");
    const gs::image& photo = scene.train[view_called(scene, most.name)].pixels;
    std::size_t striped = 0, masked = 0;
    for (std::size_t i = 0; i < photo.rgba.size() / 4; ++i) {
        const auto rgb = std::to_array(
            {most.pixels.rgba[4 * i], most.pixels.rgba[4 * i + 1], most.pixels.rgba[4 * i + 2]});
        const bool is_stripe = rgb == std::to_array<std::uint8_t>({60, 0, 50}) ||
                               rgb == std::to_array<std::uint8_t>({255, 0, 200});
        masked += photo.is_masked(i) ? 1 : 0;
        striped += is_stripe && photo.is_masked(i) ? 1 : 0;
        CHECK(most.pixels.rgba[4 * i + 3] == 255);
    }
    CHECK(masked > 0);
    CHECK(striped == masked);
    double largest = 0;
    for (const auto& [number, share] : found.charts.at(0).curves.at(0).points)
        largest = std::max(largest, share);
    CHECK(largest ==
          doctest::Approx(100 * static_cast<double>(masked) / static_cast<double>(photo.rgba.size() / 4)));
}

TEST_CASE("explain: the depth map that agrees least is shown, with near parts in white") {
    gs::scene scene = explained_scene("spheres,views=6,depths=0.01");
    for (std::uint16_t& x : scene.train[2].depths.values) x = static_cast<std::uint16_t>(65535 - x);
    const explanation found = explained("depth", scene);
    CHECK(view_called(scene, photo_labelled(found, "Map that agrees least").name) == 2);
    CHECK(found.charts.at(0).curves.at(0).points.at(2).second < 0.5);
    CHECK(found.charts.at(0).curves.at(0).points.at(4).second > 0.9);
    REQUIRE(found.photos.size() == 4);
    CHECK(found.photos[0].name == found.photos[1].name);
    const gs::pages::marked_photo& map = found.photos[3];
    const gs::depth_map& shown = scene.train[view_called(scene, map.name)].depths;
    const auto near = static_cast<std::size_t>(std::ranges::max_element(shown.values) - shown.values.begin());
    CHECK(map.pixels.rgba[4 * near] == 255);
}

TEST_CASE("explain: a lens is drawn as a curve, and each kind of lens as a photo") {
    gs::scene scene = explained_scene("spheres,fisheye=120,views=3,points=300");
    const explanation found = explained("lens", scene);
    REQUIRE(found.charts.size() == 2);
    const auto& [degrees, radius] = found.charts[1].curves[0].points.back();
    CHECK(radius == doctest::Approx(scene.train[0].camera.fisheye->radius(degrees * std::acos(-1.0) / 180)));
    CHECK(photo_labelled(found, "Widest fisheye photo").name == scene.train[0].name);
    scene.train[1].camera = explained_scene("spheres,panorama=1,views=1,points=9").train[0].camera;
    scene.train[2].camera = explained_scene("spheres,views=1,points=9").train[0].camera;
    const explanation all = explained("lens", scene);
    CHECK(photo_labelled(all, "Panorama").name == scene.train[1].name);
    CHECK(photo_labelled(all, "Widest pinhole photo").name == scene.train[2].name);
}

TEST_CASE("explain: lens distortion that loading removed is drawn as a shift") {
    gs::scene scene = explained_scene("spheres,views=3,points=300");
    const gs::scene_statistics statistics(scene);
    const auto finding_of_lens = [&] {
        for (const auto& f : all_features())
            if (f->name() == "lens") return f->analyze(statistics);
        return finding{};
    };
    CHECK(finding_of_lens().evidence == "all cameras are pinhole cameras");
    scene.train[0].removed_distortion.k1 = -0.1;
    scene.train[2].removed_distortion.k1 = -0.2;
    CHECK(finding_of_lens().evidence == "2 of 3 photos had lens distortion, which loading removed");
    const explanation found = explained("lens", scene);
    CHECK(photo_labelled(found, "Photo with the strongest distortion").name == scene.train[2].name);
    const gs::camera& c = scene.train[2].camera;
    const double corner = std::hypot(c.width - c.cx, c.height - c.cy) / c.fx;
    REQUIRE(found.charts.size() == 2);
    const auto& [share, shift] = found.charts[1].curves[0].points.back();
    CHECK(share == 100);
    CHECK(shift == doctest::Approx(-0.2 * std::pow(corner, 3) * c.fx));
}

TEST_CASE("explain: transparent parts of a photo appear as a checkerboard") {
    const explanation found = explained("background", explained_scene("alpha,views=3,points=300"));
    const gs::image& shown = photo_labelled(found, "Transparent photo").pixels;
    CHECK(int{shown.rgba[0]} == 150);
    CHECK(int{shown.rgba[4 * 2]} == 210);
    CHECK(found.options == std::vector<std::string>{"--background black"});
    CHECK(explained("background", explained_scene("spheres,views=3,points=300")).options ==
          std::vector<std::string>{"--background white"});
}
