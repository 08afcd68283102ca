// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "features/depth/depth_agreement.hpp"
#include "features/feature.hpp"
#include "features/sh_degree/direction.hpp"
#include "features/sky/sky_cells.hpp"
#include "features/sky/sky_distance.hpp"
#include "features/sky/sky_fit.hpp"
#include "model/spherical_harmonics.hpp"
#include "readers/load_scene.hpp"
#include "readers/synthetic/synthetic_parameters.hpp"
#include "scene/photo_brightness.hpp"
#include "scene/scene_statistics.hpp"

namespace {

using namespace gs::features;

gs::scene made(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    return gs::load_scene(o, {});
}

/// Returns a feature's finding in the photos.
finding analyzed(std::string_view name, const gs::scene& scene) {
    for (const auto& f : all_features())
        if (f->name() == name) return f->analyze(gs::scene_statistics(scene));
    FAIL("there is no feature " << name);
    return {};
}

sky_fit sky_of(const gs::scene& scene) { return fit_sky(scene, divide_photos(scene), {}); }

direction_statistics direction_of(const gs::scene& scene) {
    return measure_direction(gs::scene_statistics(scene));
}

}  // namespace

TEST_CASE("long: detection recommends the effects that a scene was made with, and no other") {
    const struct {
        const char* scene;
        std::set<std::string> effects;
    } cases[] = {
        {"spheres", {}},
        {"spheres,noise=0.03", {}},
        {"spheres,gloss=0.6", {"direction"}},
        {"spheres,exposure=0.3,noise=0.01", {"exposure"}},
        {"spheres,vignetting=0.4,noise=0.03", {"vignetting"}},
        {"spheres,vignetting=0.3,exposure=0.3,sky=0.7", {"vignetting", "exposure", "sky"}},
        {"spheres,exposure=0.5,response=0.8,noise=0.01", {"exposure", "response"}},
        {"spheres,scales=4", {"antialiasing"}},
        {"spheres,blur=8", {"motion"}},
        {"spheres,poses=0.6", {"poses"}},
        {"spheres,poses=1,exposure=0.3,noise=0.01", {"poses", "exposure"}},
        {"spheres,sky=0.4,noise=0.03", {"sky"}},
        {"spheres,sky=1,exposure=0.3,scales=4", {"sky", "exposure", "antialiasing"}},
        {"spheres,walls=0.8", {}},
        {"spheres,walls=0.8,exposure=0.3,noise=0.01", {"exposure"}},
        {"spheres,passers=0.1", {"masks"}},
        {"spheres,fisheye=60,gloss=0.6,sky=0.8", {"lens", "direction", "sky"}},
        {"alpha,fisheye=60", {"lens", "background"}},
        {"spheres,depths=0.05,noise=0.01", {"depth"}},
        {"spheres,depths=2", {}},
        {"alpha,depths=0,exposure=0.3,passers=0.1", {"depth", "exposure", "masks", "background"}},
        {"alpha", {"background"}},
        {"alpha,gloss=0.6,exposure=0.3,passers=0.1", {"direction", "exposure", "masks", "background"}}};
    for (const auto& c : cases) {
        INFO(c.scene);
        const gs::scene scene = made(c.scene);
        const gs::scene_statistics statistics(scene);
        REQUIRE(all_features().size() == 13);
        for (const auto& f : all_features()) {
            INFO(f->name());
            const finding found = f->analyze(statistics);
            REQUIRE(found.recommended);
            CHECK(*found.recommended == c.effects.contains(std::string(f->name())));
        }
    }
}

TEST_CASE("lenses are reported: fisheye lenses, panoramas, or both") {
    gs::scene scene = made("spheres,panorama=1,views=3");
    const finding all = analyzed("lens", scene);
    CHECK(all.recommended == true);
    CHECK(all.choice == "panorama");
    CHECK(all.evidence == "3 of 3 photos are panoramas");
    scene.train[0].camera = made("spheres,fisheye=60,views=1").train[0].camera;
    CHECK(analyzed("lens", scene).choice == "fisheye and panorama");
    CHECK(analyzed("lens", scene).evidence.ends_with(", and 2 of 3 photos are panoramas"));
}

TEST_CASE("a sky is what it was made of, and begins from that") {
    const gs::scene scene = made("spheres,sky=0.8");
    const sky_fit found = sky_of(scene);
    CHECK(found.share > 0.3);
    CHECK(found.share > 0.99 * found.empty);
    double square = 0, values = 0;
    for (const gs::view& v : scene.train) {
        // Three corners, which show no surface.
        for (const auto& [x, y] : {std::pair{3, 3}, {v.camera.width - 4, 3}, {3, v.camera.height - 4}}) {
            const auto i = static_cast<std::size_t>(y * v.camera.width + x);
            const glm::dvec3 ray((x + 0.5 - v.camera.cx) / v.camera.fx, (y + 0.5 - v.camera.cy) / v.camera.fy,
                                 1);
            double basis[16];
            gs::sh_basis<double>(3, glm::normalize(glm::transpose(v.camera.rotation) * ray), basis);
            for (std::size_t c = 0; c < 3; ++c) {
                double color = 0.5;
                for (std::size_t k = 0; k < 16; ++k)
                    color += basis[k] * static_cast<double>(found.coefficients[3 * k + c]);
                square += std::pow(color - v.pixels.rgba[4 * i + c] / 255.0, 2);
                ++values;
            }
        }
    }
    CHECK(std::sqrt(square / values) < 0.02);
    CHECK(sky_of(made("spheres,sky=0.04")).brightness < 0.08);
    gs::scene bare = scene;
    bare.points.clear();
    CHECK_FALSE(sky_of(bare).has_points);
    CHECK_THROWS_WITH_AS(made("alpha,sky=1"), doctest::Contains("it has no sky"), gs::error);
}

TEST_CASE("a smooth wall is not a sky, because the photos disagree about it at infinity") {
    const auto distance_of = [](const gs::scene& scene, const std::vector<double>& brighter) {
        const std::vector<photo_cells> cells = divide_photos(scene);
        return measure_distance(scene, cells, fit_sky(scene, cells, brighter), brighter);
    };
    const gs::scene room = made("spheres,walls=0.8");
    const sky_fit wall = sky_of(room);
    CHECK(wall.share > 0.3);  // a function of the direction predicts the wall, too
    CHECK(wall.share > 0.9 * wall.empty);
    CHECK(wall.brightness > 0.3);
    const sky_distance near = distance_of(room, {});
    CHECK(near.is_near());
    CHECK(near.near_only > 10 * near.far_only);
    CHECK(near.distance > 1);
    const finding found = analyzed("sky", room);
    CHECK(found.recommended == false);
    CHECK(found.evidence.find("these are near") != std::string::npos);

    const gs::scene outdoors = made("spheres,sky=0.8");
    const sky_distance far = distance_of(outdoors, {});
    CHECK(far.distance > 0);  // the photos were compared
    CHECK_FALSE(far.is_near());
    CHECK(analyzed("sky", outdoors).recommended == true);
    CHECK(analyzed("sky", outdoors).evidence.find("near") == std::string::npos);

    // The brightness of the photos must be known, or exposures look like a disagreement.
    gs::scene exposed = made("spheres,walls=0.8,exposure=0.3,scales=4");
    CHECK(distance_of(exposed, gs::scene_statistics(exposed).brightness().log2).is_near());
    // One camera has no parallax.
    gs::scene alone = room;
    alone.train.resize(1);
    CHECK(distance_of(alone, {}).distance == 0);
    CHECK_FALSE(distance_of(alone, {}).is_near());
}

TEST_CASE("a lens that darkens corners does not make a sky look near") {
    const gs::scene scene = made("spheres,gloss=0.87,vignetting=0.49,sky=0.54,passers=0.18");
    std::vector<photo_cells> cells = divide_photos(scene);
    const sky_fit fit = fit_sky(scene, cells, {});
    CHECK(measure_distance(scene, cells, fit, {}).is_near());
    const double strength = strength_of_falloff(scene, cells, fit, {});
    CHECK(strength == doctest::Approx(0.49).epsilon(0.25));
    remove_falloff(scene, {strength, strength, strength}, cells);
    CHECK_FALSE(measure_distance(scene, cells, fit, {}).is_near());
    CHECK(analyzed("sky", scene).recommended == true);

    const gs::scene clear = made("spheres,sky=0.8");
    const std::vector<photo_cells> even = divide_photos(clear);
    CHECK(strength_of_falloff(clear, even, fit_sky(clear, even, {}), {}) == 0);
    CHECK(analyzed("sky", made("spheres,walls=0.8,vignetting=0.4")).recommended == false);
}

TEST_CASE("synthetic walls are behind the spheres, at a finite distance") {
    const auto corner_depths = [](const std::string& parameters) {
        const gs::scene scene = made(parameters);
        std::set<std::uint16_t> values;
        const gs::depth_map& map = scene.train[0].depths;
        for (const int x : {0, map.width - 1})
            for (const int y : {0, map.height - 1})
                values.insert(map.values[static_cast<std::size_t>(y * map.width + x)]);
        return values.size();
    };
    CHECK(corner_depths("spheres,views=1,depths=0") == 1);
    CHECK(corner_depths("spheres,views=1,depths=0,walls=0.5") > 1);
    CHECK_THROWS_WITH_AS(made("alpha,walls=1"), doctest::Contains("it has no walls"), gs::error);
}

TEST_CASE("moving things do not pass for exposures, or for colors that depend on the direction") {
    const gs::scene glossy = made("alpha,gloss=0.44,scales=3.19,moving=0.2");
    CHECK(analyzed("exposure", glossy).recommended == false);
    CHECK(analyzed("direction", glossy).recommended == true);
    CHECK(analyzed("direction", made("spheres,moving=0.14,passers=0.07")).recommended == false);
}

TEST_CASE("a scene without points is not told what it needs") {
    gs::scene scene = made("alpha,gloss=0.6");
    scene.points.clear();
    const gs::scene_statistics statistics(scene);
    for (const auto& f : all_features()) {
        INFO(f->name());
        const std::set<std::string_view> of_files = {"background", "vignetting", "response", "motion",
                                                     "masks",      "depth",      "lens"};
        CHECK(f->analyze(statistics).recommended.has_value() == of_files.contains(f->name()));
    }
    CHECK(measure_direction(statistics).degree() == 3);
    CHECK(analyzed("direction", scene).choice == "--sh-degree 3");
    // With points of which next to none tells there is nothing to tell it by, and with a few more there is.
    direction_statistics few = measure_direction(statistics);
    few.has_points = true;
    for (const auto& [points, degree] : {std::pair{0, 0}, {9, 0}, {10, 3}, {49, 3}}) {
        few.points = static_cast<std::size_t>(points);
        CHECK(few.degree() == degree);
        CHECK_FALSE(few.is_known());
    }
    const gs::scene glossy = made("spheres,gloss=0.6");
    for (const auto& [at_most, degree] : {std::pair{9, 0}, {49, 3}}) {
        // Half of the points, and again half, until so few of them tell.
        gs::scene sparse = glossy;
        direction_statistics told = direction_of(sparse);
        for (std::size_t every = 2; told.points > static_cast<std::size_t>(at_most); every *= 2) {
            sparse.points.clear();
            for (std::size_t i = 0; i < glossy.points.size(); i += every)
                sparse.points.push_back(glossy.points[i]);
            told = direction_of(sparse);
        }
        CAPTURE(told.points);
        REQUIRE_FALSE(told.is_known());
        CHECK((told.points < 10) == (degree == 0));
        const finding found = analyzed("direction", sparse);
        CHECK(found.choice == "--sh-degree " + std::to_string(degree));
        CHECK_FALSE(found.recommended);
        CHECK(found.if_unknown == (degree > 0));
    }
}

TEST_CASE("what is matte needs no degree, and what mirrors a sky needs several") {
    CHECK(direction_of(made("spheres")).degree() == 0);
    CHECK(direction_of(made("spheres,gloss=0.8")).degree() >= 2);
}

TEST_CASE("exposures are found to 0.7 %, on average") {
    // Each photo's own, by the formula of the synthetic scenes.
    gs::scene plain = made("spheres"), varied = made("spheres,exposure=0.3");
    const gs::photo_brightness found =
        gs::estimate_brightness(gs::observe_points(varied), varied.train.size());
    double mean = 0, square = 0;
    std::vector<double> off;
    for (std::size_t v = 0; v < varied.train.size(); ++v) {
        if (found.error[v] == 0) continue;
        // The brightness of pixels that neither photo saturates.
        double brighter = 0;
        int n = 0;
        const auto &a = plain.train[v].pixels.rgba, &b = varied.train[v].pixels.rgba;
        for (std::size_t i = 0; i < a.size(); i += 4)
            if (a[i] > 60 && b[i] > 60 && a[i] < 240 && b[i] < 240) {
                brighter += std::log2(double(b[i]) / a[i]);
                ++n;
            }
        REQUIRE(n > 0);
        off.push_back(found.log2[v] - brighter / n);
        mean += off.back();
    }
    REQUIRE(off.size() > 30);
    for (const double x : off) square += std::pow(x - mean / double(off.size()), 2);
    CHECK(std::sqrt(square / double(off.size())) < 0.01);
}

TEST_CASE("small differences of exposures count if cameras are at similar distances") {
    const auto differ = [](const char* scene) { return analyzed("exposure", made(scene)).recommended; };
    CHECK(differ("spheres,exposure=0.08,noise=0.01,views=16") == true);
    CHECK(differ("spheres,exposure=0.04,noise=0.01,views=16") == false);
    CHECK(differ("spheres,exposure=0.08,scales=4,noise=0.01,views=24") == false);
    CHECK(differ("spheres,exposure=0.15,scales=4,noise=0.01,views=24") == true);
}

TEST_CASE(
    "exposures are found at rough points if few points are smooth, and things in few photos do not count") {
    // Photos from very different distances show few points smoothly.
    const gs::scene rough = made("alpha,gloss=0.99,exposure=0.49,scales=3.79,moving=0.18,fisheye=61");
    const gs::scene_statistics statistics(rough);
    CHECK(statistics.smooth_points().size() < 100);
    CHECK(statistics.brightness().is_rough);
    CHECK(statistics.brightness().points > 100);
    CHECK(statistics.brightness_of_smooth().points == statistics.smooth_points().size());
    CHECK(analyzed("exposure", rough).recommended == true);
    CHECK(analyzed("exposure", made("alpha,scales=6.32,blur=11.16,moving=0.37,noise=0.015")).recommended ==
          false);
    const gs::scene plain = made("spheres,exposure=0.3");
    CHECK_FALSE(gs::scene_statistics(plain).brightness().is_rough);
}

TEST_CASE(
    "exposures along a walk of two thousand photos are found, where each shares points with its neighbors "
    "alone") {
    constexpr std::size_t views = 2000, at_once = 5, points_at_once = 5;
    std::mt19937 random(1);
    const auto noise = [&](double size) { return size * (static_cast<double>(random()) / 2147483648.0 - 1); };
    std::vector<double> truth(views);
    for (std::size_t v = 1; v < views; ++v) truth[v] = 0.98 * truth[v - 1] + noise(0.1);
    double mean = 0;
    for (const double x : truth) mean += x / views;
    gs::observed_points points;
    for (std::size_t v = 0; v + at_once <= views; ++v)
        for (std::size_t k = 0; k < points_at_once; ++k) {
            points.emplace_back();
            for (std::size_t i = v; i < v + at_once; ++i) {
                gs::observation& o = points.back().emplace_back();
                o.view = static_cast<std::uint32_t>(i);
                o.color = glm::vec3(static_cast<float>(0.3 * std::exp2(truth[i] - mean + noise(0.0003))));
            }
        }
    const gs::photo_brightness found = gs::estimate_brightness(points, views);
    double square = 0;
    for (std::size_t v = at_once; v < views - at_once; ++v)  // the first and the last share too little
        square += std::pow(found.log2[v] - (truth[v] - mean), 2) / views;
    CHECK(std::sqrt(square) < 0.01);
}

TEST_CASE(
    "a line through values and inverse depths is found behind outliers, and is not flattened by noise") {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<depth_pair> pairs;
    for (int i = 0; i < 2000; ++i) {
        const double inverse = 0.2 + 0.05 * normal(random);
        pairs.push_back({1000 + 40000 * (inverse + 0.03 * normal(random)), inverse});
        if (i % 20 == 0) pairs.back().inverse_depth = 2;
    }
    const depth_line line = fit_line(pairs);
    CHECK(line.scale == doctest::Approx(1 / 40000.0).epsilon(0.1));
    CHECK(line.scale * (1000 + 40000 * 0.2) + line.offset == doctest::Approx(0.2).epsilon(0.02));
    CHECK(line.correlation > 0.6);
    for (depth_pair& p : pairs) p.value = 1000 * normal(random);
    CHECK(std::abs(fit_line(pairs).correlation) < 0.1);
    for (depth_pair& p : pairs) p.value = 7;
    CHECK(fit_line(pairs).correlation == 0);
}

TEST_CASE("depth maps become the inverse depths of what photos show, and wrong ones are not used") {
    gs::scene scene = made("spheres,views=6,depths=0.01");
    scene.train[0].depths = {};
    for (std::uint16_t& x : scene.train[1].depths.values) x = static_cast<std::uint16_t>(65535 - x);
    scene.train[2].depths.values.assign(scene.train[2].depths.values.size(), 0);
    const depth_agreement found = compare_depths(scene);
    CHECK(found.photos == 6);
    CHECK(found.with_map == 5);
    CHECK(found.told == 4);
    CHECK(found.agreeing == 3);
    CHECK(found.correlation > 0.95);
    for (std::size_t v = 0; v < 6; ++v) {
        CAPTURE(v);
        const gs::view& photo = scene.train[v];
        CHECK((found.fits[v].scale > 0) == (v > 2));
        if (v <= 2) continue;
        std::vector<double> off;
        for (const gs::place_in_photo& p : gs::points_in_sight(photo.camera, scene.points)) {
            const auto i =
                static_cast<std::size_t>(static_cast<int>(p.y) * photo.depths.width + static_cast<int>(p.x));
            off.push_back(std::abs(static_cast<double>(found.fits[v].scale) * photo.depths.values[i] +
                                   static_cast<double>(found.fits[v].offset) - 1 / p.depth) *
                          p.depth);
        }
        std::ranges::nth_element(off, off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2));
        CHECK(off[off.size() / 2] < 0.015);
    }
    const finding agreeing = analyzed("depth", scene);
    REQUIRE(agreeing.recommended);
    CHECK(*agreeing.recommended);
    scene.points.clear();
    CHECK_FALSE(analyzed("depth", scene).recommended);
}

TEST_CASE("a parameter of a synthetic scene that is wrong is named") {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            gs::parse_synthetic(text);
        } catch (const gs::error& e) {
            return e.what();
        }
        return "";
    };
    CHECK(refusal("spheres,gloss=0.5,noise=0.1") == "");
    CHECK(
        refusal("spheres,glos=0.5") ==
        "a synthetic scene has no parameter 'glos'; there are: gloss, exposure, scales, distance, passers, "
        "moving, blur, shutter, vignetting, response, sky, walls, fisheye, panorama, depths, points, views, "
        "poses, noise");
    CHECK(refusal("spheres,gloss=2") == "the 'gloss' of a synthetic scene is a number from 0 to 1, not '2'");
    CHECK(refusal("spheres,gloss") == "the 'gloss' of a synthetic scene is a number from 0 to 1, not ''");
    CHECK(
        refusal("spheres,") ==
        "a synthetic scene has no parameter ''; there are: gloss, exposure, scales, distance, passers, "
        "moving, blur, shutter, vignetting, response, sky, walls, fisheye, panorama, depths, points, views, "
        "poses, noise");
    CHECK(refusal("spheres,gloss=nan") ==
          "the 'gloss' of a synthetic scene is a number from 0 to 1, not 'nan'");
    CHECK(refusal("spheres,views=4,depths=0") == "");
    CHECK(refusal("spheres,panorama=1") == "");
    CHECK(
        refusal("spheres,panorama=1,fisheye=90") ==
        "a synthetic scene has either a 'fisheye' or a 'panorama', not both: spheres,panorama=1,fisheye=90");
    CHECK(refusal("spheres,sky=1,walls=1") ==
          "a synthetic scene has either a 'sky' or 'walls', not both: spheres,sky=1,walls=1");
    CHECK(refusal("spheres,vignetting=0.3,panorama=1") ==
          "a synthetic scene has either 'vignetting' or a 'panorama', not both: "
          "spheres,vignetting=0.3,panorama=1");
    CHECK_THROWS_WITH_AS(made("alpha,vignetting=0.4"), doctest::Contains("it has no vignetting"), gs::error);
    CHECK_THROWS_WITH_AS(made("alpha,response=0.4"), doctest::Contains("it has no response"), gs::error);
    CHECK(refusal("spheres,response=0.3,panorama=1") ==
          "a synthetic scene has either a 'response' or a 'panorama', not both: "
          "spheres,response=0.3,panorama=1");
    CHECK(refusal("spheres,views=4.5") ==
          "the 'views' of a synthetic scene is a whole number from 1 to 48, not '4.5'");
    CHECK(refusal("spheres,depths=-1") ==
          "the 'depths' of a synthetic scene is a number from 0 to 10, not '-1'");
    CHECK(refusal("spheres,gloss=0,gloss=1") ==
          "a synthetic scene has one 'gloss', not several: spheres,gloss=0,gloss=1");
}
