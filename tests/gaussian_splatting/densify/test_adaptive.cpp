// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>

#include "../training/engines.hpp"
#include "model/opacity.hpp"
#include "render/project/geometry.hpp"
#include "training/initialize.hpp"

namespace {

using gs::gaussians;
using gs::train::adaptive_config;
using gs::train::engine;

/// Extents of a scene in which all Gaussians count as small, or as large.
constexpr double copies_all = 1e11, splits_all = 1e-7;
/// Sums of gradients that do not depend on the order in which threads add.
constexpr gs::accumulator in_any_order = gs::accumulator::fixed;

/// Steps on each training view with learning rates of 0: collects statistics and moments, changes nothing.
void look_at_all(engine& e, const gs::scene& scene, const gaussians& model, int sh_degree = 0) {
    e.set_views(scene.train, scene.test);
    e.set_model(model);
    e.begin(setup_with(in_any_order));
    e.reserve();
    auto still = plan_for(0);
    still.sh_degree = sh_degree;
    still.rates = {};
    for (still.view = 0; still.view < scene.train.size(); ++still.view) e.step(still);
}

}  // namespace

TEST_CASE("adaptive: Gaussians with the largest gradients grow first, up to the cap") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 0, 1000, 1);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(model);
        e->reserve();
        for (std::size_t v = 0; v < 4; ++v) e->step(plan_for(v));
        const gaussians stepped = e->get_model();
        adaptive_config config;
        config.densify_grad_threshold = 1e-12;  // every Gaussian with a gradient
        config.least_opacity = 0;
        config.revised_opacity = false;
        densify_once(*e, config, 1100, copies_all);
        CHECK(e->count() == 1100);

        // Copies are exact: each old Gaussian appears once or twice, in order.
        const gaussians grown = e->get_model();
        std::size_t from = 0, twice = 0;
        for (std::size_t i = 0; i < grown.count(); ++i) {
            const bool same_as_from =
                std::equal(grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i),
                           grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i + 3),
                           stepped.mean.begin() + static_cast<std::ptrdiff_t>(3 * from));
            if (!same_as_from) ++from;
            REQUIRE(std::equal(grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i),
                               grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i + 3),
                               stepped.mean.begin() + static_cast<std::ptrdiff_t>(3 * from)));
            CHECK(grown.opacity[i] == stepped.opacity[from]);
            if (i > 0 && same_as_from) ++twice;
        }
        CHECK(from == 999);
        CHECK(twice == 100);

        // No statistics since then: nothing grows.
        densify_once(*e, config, 1100, copies_all);
        CHECK(e->count() == 1100);
    }
}

TEST_CASE("adaptive: a budget limits growth to the Gaussians with the largest gradients") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 0, 1000, 1);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        auto still = plan_for(0);
        still.rates = {};
        adaptive_config config;
        config.densify_grad_threshold = 0;  // every Gaussian
        config.densify_until_iter = 3;      // densifies twice
        config.least_opacity = 0;
        const auto grown = [&](std::optional<std::size_t> budget) {
            e->set_model(model);
            e->reserve();
            e->step(still);
            config.budget = budget;
            densify_once(*e, config, 1100, copies_all);
            return e->get_model();
        };
        CHECK(grown(1000).count() == 1000);
        const gaussians few = grown(1080), many = grown({});
        CHECK(few.count() == 1040);
        CHECK(many.count() == 1100);
        // The 40 copied ones are among the 100.
        const auto places_there_twice = [](const gaussians& g) {
            std::set<std::array<float, 3>> once, twice;
            for (std::size_t i = 0; i < g.count(); ++i) {
                const std::array place{g.mean[3 * i], g.mean[3 * i + 1], g.mean[3 * i + 2]};
                if (!once.insert(place).second) twice.insert(place);
            }
            return twice;
        };
        const auto first = places_there_twice(few), all = places_there_twice(many);
        CHECK(first.size() == 40);
        CHECK(std::ranges::includes(all, first));
    }
}

TEST_CASE("adaptive: a copy and its original together are as opaque as it was alone") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 200, 1);
    for (std::size_t i = 0; i < 200; ++i) model.opacity[i] = -8 + 0.1f * static_cast<float>(i % 160);
    model.opacity[0] = 200;
    for (const auto make : engines()) {
        const auto e = make();
        look_at_all(*e, scene, model);
        adaptive_config config;
        config.densify_grad_threshold = 1e-12;
        config.least_opacity = 0;
        densify_once(*e, config, 1000, copies_all);
        const gaussians grown = e->get_model();
        REQUIRE(grown.count() > 300);
        for (std::size_t i = 0, parent = 0; i < grown.count(); ++parent) {
            const double logit = static_cast<double>(model.opacity[parent]);
            const bool is_copied = i + 1 < grown.count() &&
                                   std::equal(grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                              grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i + 3),
                                              grown.mean.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
            CAPTURE(logit);
            if (!is_copied) {
                CHECK(grown.opacity[i++] == model.opacity[parent]);
                continue;
            }
            CHECK(std::isfinite(grown.opacity[i]));
            CHECK(grown.opacity[i] == grown.opacity[i + 1]);
            // Both together transmit as much light as the one: log1p(e^logit) is -log of it.
            const double through_one = std::log1p(std::exp(static_cast<double>(grown.opacity[i])));
            if (logit < 80)
                CHECK(2 * through_one == doctest::Approx(std::log1p(std::exp(logit))).epsilon(1e-5));
            i += 2;
        }
    }
}

TEST_CASE("adaptive: a split places two thinner Gaussians on the longest axis of their origin") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 200, 1);
    for (std::size_t i = 0; i < 200; ++i) {
        model.log_scale[3 * i + i % 3] += 0.5f;
        for (std::size_t k = 0; k < 4; ++k) model.quaternion[4 * i + k] = k == i % 4 ? 1 : 0.25f;
        model.opacity[i] = static_cast<float>(i) / 20 - 5;
    }
    model.opacity[7] = 90;
    for (const auto make : engines()) {
        const auto e = make();
        look_at_all(*e, scene, model);
        adaptive_config config;
        config.densify_grad_threshold = 1e-12;
        config.least_opacity = 0;
        densify_once(*e, config, 1000, splits_all);
        const gaussians grown = e->get_model();
        REQUIRE(grown.count() > 300);
        const auto center = [](const gaussians& of, std::size_t i) {
            return glm::vec3(of.mean[3 * i], of.mean[3 * i + 1], of.mean[3 * i + 2]);
        };
        std::size_t splits = 0;
        for (std::size_t i = 0, parent = 0; i < grown.count(); ++i, ++parent) {
            REQUIRE(parent < model.count());
            if (center(grown, i) == center(model, parent)) continue;
            REQUIRE(i + 1 < grown.count());
            ++splits;
            const std::size_t axis = parent % 3;
            const float* q = &model.quaternion[4 * parent];
            const glm::mat3 rotation =
                gs::raster::rotation_of(glm::normalize(glm::vec4(q[0], q[1], q[2], q[3])));
            const glm::vec3 step = 0.5f * std::exp(model.log_scale[3 * parent + axis]) *
                                   rotation[static_cast<glm::vec3::length_type>(axis)];
            const float opacity = 0.6f * gs::sigmoid(model.opacity[parent]);
            for (std::size_t half = 0; half < 2; ++half) {
                const glm::vec3 expected = center(model, parent) + (half == 0 ? -step : step);
                CHECK(glm::distance(center(grown, i + half), expected) < 1e-4f * glm::length(step) + 1e-6f);
                for (std::size_t k = 0; k < 3; ++k)
                    CHECK(
                        grown.log_scale[3 * (i + half) + k] ==
                        doctest::Approx(model.log_scale[3 * parent + k] + std::log(k == axis ? 0.5 : 0.85)));
                CHECK(gs::sigmoid(grown.opacity[i + half]) == doctest::Approx(opacity).epsilon(1e-4));
            }
            ++i;
        }
        CHECK(splits == grown.count() - model.count());
    }
}

TEST_CASE("adaptive: removes transparent Gaussians, and none for its size") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 300, 1);
    for (std::size_t i = 0; i < 300; i += 3) model.opacity[i] = -10;
    for (std::size_t i = 1; i < 300; i += 3) model.log_scale[3 * i + 1] = 3;
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(model);
        densify_once(*e, {.densify_grad_threshold = 1e9}, 1000);
        CHECK(e->count() == 200);
    }
}

TEST_CASE("adaptive: pruning removes the given share and keeps the other Gaussians bit for bit") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 1, 300, 1);
    for (std::size_t i = 0; i < 300; i += 4) model.opacity[i] = -20;  // in no image
    for (const auto make : engines()) {
        const auto e = make();
        look_at_all(*e, scene, model);
        prune_once(*e, 0.001);  // less than one Gaussian
        CHECK(e->count() == 300);
        look_at_all(*e, scene, model);
        prune_once(*e, 0.2);
        const gaussians rest = e->get_model();
        REQUIRE(rest.count() == 240);
        CHECK(std::ranges::count(rest.opacity, -20.0f) == 15);
        for (std::size_t i = 0, from = 0; i < 240; ++i, ++from) {
            while (from < 300 && rest.mean[3 * i] != model.mean[3 * from]) {
                CHECK(model.opacity[from] == -20);
                ++from;
            }
            REQUIRE(from < 300);
            CHECK(rest.opacity[i] == model.opacity[from]);
            CHECK(std::equal(&rest.sh_rest[9 * i], &rest.sh_rest[9 * i] + 9, &model.sh_rest[9 * from]));
        }
    }
}

TEST_CASE("adaptive: pruning removes the Gaussians with the smallest gradients") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 300, 1);
    for (std::size_t i = 0; i < 300; i += 4) model.opacity[i] = -20;    // in no image
    for (std::size_t i = 1; i < 300; i += 4) model.opacity[i] = -5.3f;  // hardly visible
    const auto count = [](const gaussians& of, float opacity) {
        return std::ranges::count(of.opacity, opacity);
    };
    for (const auto make : engines()) {
        const auto e = make();
        look_at_all(*e, scene, model);
        prune_once(*e, 0.4);
        const gaussians rest = e->get_model();
        REQUIRE(rest.count() == 180);
        CHECK(count(rest, -20.0f) == 0);
        CHECK(count(rest, -5.3f) <= 75 - 40);  // at least 40 of the other 45
    }
}

TEST_CASE("adaptive: Gaussians that pruning keeps also keep their moments") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 1, 300, 1);
    for (std::size_t i = 0; i < 240; i += 4) model.opacity[i] = -20;  // in no image: to be removed
    for (const auto make : engines()) {
        const auto e = make();
        const auto trained = [&](bool prunes) {
            look_at_all(*e, scene, model, 1);
            if (prunes) prune_once(*e, 0.2);
            auto plan = plan_for(0);
            plan.sh_degree = 1;
            plan.rates.fill(0.01f);
            e->begin(setup_with(in_any_order));
            e->step(plan);
            return e->get_model();
        };
        const gaussians all = trained(false), rest = trained(true);
        REQUIRE(rest.count() == 240);
        std::size_t values = 0, alike = 0;
        const auto compare = [&](const std::vector<float>& a, const std::vector<float>& b,
                                 std::size_t width) {
            for (std::size_t i = 0, from = 0; from < 300; ++from) {
                if (model.opacity[from] == -20) continue;
                for (std::size_t k = 0; k < width; ++k, ++values)
                    if (a[i * width + k] == b[from * width + k]) ++alike;
                ++i;
            }
        };
        compare(rest.mean, all.mean, 3);
        compare(rest.log_scale, all.log_scale, 3);
        compare(rest.quaternion, all.quaternion, 4);
        compare(rest.opacity, all.opacity, 1);
        compare(rest.sh_constant, all.sh_constant, 3);
        compare(rest.sh_rest, all.sh_rest, 9);
        CHECK(alike == values);
    }
}

TEST_CASE("adaptive: Adam's catch-up steps survive the removal of other Gaussians") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 1000, 1);
    std::ranges::fill(model.opacity, 6.0f);                             // those in front hide others
    for (float& c : model.sh_constant) c = std::clamp(c, -1.5f, 1.5f);  // black has no gradient
    constexpr std::size_t dropped = 100;
    std::fill_n(model.opacity.begin(), dropped, -20.0f);
    constexpr float rate = 0.01f;
    const auto plan = [](std::size_t view, float all) {
        auto p = plan_for(view);
        p.rates.fill(all);
        return p;
    };
    // By Adam, from two equal gradients five steps apart, at the rates and corrections of the last step.
    constexpr int missed = 5, last = missed + 2;
    const double by_first = 1 / (1 - std::pow(0.9, last)), by_second = 1 / (1 - std::pow(0.999, last));
    double m = 0.1, v = 0.001, expected = 0;
    for (int step = 0; step <= missed; ++step) {
        const double gradient = step < missed ? 0 : 1;
        m = 0.9 * m + 0.1 * gradient;
        v = 0.999 * v + 0.001 * gradient;
        expected += rate * m * by_first / std::sqrt(v * by_second);
    }
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        const auto seen_by = [&](std::size_t view) {
            e->set_model(model);
            e->begin(setup_with(in_any_order));
            e->reserve();
            e->step(plan(view, rate));
            const gaussians moved = e->get_model();
            std::vector<bool> is(model.count());
            for (std::size_t i = 0; i < is.size(); ++i) is[i] = moved.opacity[i] != model.opacity[i];
            return is;
        };
        const std::vector<bool> first = seen_by(0), second = seen_by(1);
        e->set_model(model);
        e->step(plan(0, 0));  // gives momentum to visible Gaussians
        for (int i = 0; i < missed; ++i) e->step(plan(1, 0));
        densify_once(*e, {.densify_grad_threshold = 1e30}, 0);
        REQUIRE(e->count() == model.count() - dropped);
        e->reserve();
        e->step(plan(0, rate));
        const gaussians moved = e->get_model();
        std::size_t values = 0, as_expected = 0;
        for (std::size_t i = dropped; i < model.count(); ++i) {
            if (!first[i] || second[i]) continue;
            for (std::size_t k = 0; k < 3; ++k, ++values) {
                const float by = moved.sh_constant[3 * (i - dropped) + k] - model.sh_constant[3 * i + k];
                if (std::abs(std::abs(by) - expected) < 0.02 * expected) ++as_expected;
            }
        }
        CHECK(values > 150);
        CHECK(as_expected > values * 9 / 10);  // but where a gradient is little more than rounding
    }
}

TEST_CASE("adaptive: an opacity reset lowers opacities and never raises them") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 4, 1);
    model.opacity = {-9, -4.6f, 0, 9};
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(model);
        gs::train::training_setup setup;
        setup.facts.white = true;
        setup.densification.of<gs::train::adaptive_config>().densify_from_iter = 7;
        e->begin(setup);
        e->adjust(6);
        CHECK(e->get_model().opacity == model.opacity);
        e->adjust(7);
        const float most = std::log(0.01f / 0.99f);
        CHECK(e->get_model().opacity == std::vector<float>{-9, -4.6f, most, most});
    }
}

TEST_CASE("adaptive: hides exactly the Gaussians closer to a training camera than its near plane") {
    const gs::scene scene = small_scene();
    const float near = static_cast<float>(gs::raster::near_plane), hidden = gs::logit(0);
    // Around each camera, of those to learn from and of those that are held out.
    std::vector<gs::colored_point> points;
    for (const auto* views : {&scene.train, &scene.test})
        for (const gs::view& v : *views)
            for (const double distance : {0.0, 0.5, 0.99, 1.01, 3.0})
                points.push_back(
                    {v.camera.center() + distance * double{near} * glm::dvec3(0, 0.6, -0.8), {}});
    gaussians model = gs::from_points(points, 0, points.size(), 1);
    for (std::size_t i = 0; i < model.count(); i += 7) model.opacity[i] = hidden - 1;  // no higher
    std::size_t near_ones = 0;
    std::vector<float> expected = model.opacity;
    for (std::size_t i = 0; i < model.count(); ++i) {
        double least = 1e30;
        const glm::dvec3 at{model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2]};
        for (const gs::view& v : scene.train) least = std::min(least, glm::distance(v.camera.center(), at));
        if (least >= double{near}) continue;
        ++near_ones;
        expected[i] = std::min(expected[i], hidden);
    }
    REQUIRE(near_ones == 3 * scene.train.size());
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(model);
        e->adjust(99);
        CHECK(e->get_model().opacity == model.opacity);
        e->adjust(100);
        CHECK(e->get_model().opacity == expected);
        CHECK(e->get_model().mean == model.mean);
    }
}
