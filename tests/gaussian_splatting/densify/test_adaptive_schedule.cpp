// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <optional>

#include "densify/adaptive/adaptive_schedule.hpp"

using gs::train::adaptive_config;
using gs::train::adaptive_schedule;

TEST_CASE("densification ends half-way through training, or after 40 iterations per view") {
    const adaptive_schedule half({}, {.iterations = 7000});
    CHECK_FALSE(half.densifies(500));
    CHECK(half.densifies(600));
    CHECK_FALSE(half.densifies(650));
    CHECK(half.densifies(3400));
    CHECK_FALSE(half.densifies(3500));
    CHECK(half.densify_until() == 3500);
    const auto until = [](int iterations, int views, bool transparent) {
        const gs::train::training_facts facts{
            .iterations = iterations, .views = views, .transparent = transparent};
        return adaptive_schedule({}, facts).densify_until();
    };
    CHECK(until(30000, 20, false) == 3500);
    CHECK(until(30000, 200, false) == 8000);
    CHECK(until(10000, 200, false) == 5000);
    CHECK(until(100000, 1000000000, false) == 15000);
    CHECK(until(7000, 20, true) == 3500);
    CHECK(until(30000, 20, true) == 15000);
    CHECK(until(100000, 20, true) == 15000);
    CHECK(adaptive_schedule({.densify_until_iter = 30000}, {.iterations = 7000}).densify_until() == 7000);
}

TEST_CASE("opacities are reset only when an interval of densification is left") {
    for (const bool white : {false, true}) {
        const adaptive_schedule half({}, {.iterations = 7000, .white = white});
        CHECK_FALSE(half.resets_opacity(3000));
        CHECK(half.resets_opacity(500) == white);
        const adaptive_schedule whole({.densify_until_iter = 30000}, {.iterations = 7000, .white = white});
        CHECK_FALSE(whole.resets_opacity(6000));
        const adaptive_schedule large({}, {.iterations = 100000, .views = 1000, .white = white});
        CHECK(large.resets_opacity(3000));
        CHECK(large.resets_opacity(12000));
        CHECK_FALSE(large.resets_opacity(15000));
    }
}

TEST_CASE("the shorter densification is, the larger is the growth threshold, unless it is set") {
    const auto threshold = [](const adaptive_config& config, int iterations) {
        return adaptive_schedule(config, {.iterations = iterations, .views = 1000}).growth_threshold();
    };
    CHECK(threshold({}, 30000) == doctest::Approx(8e-5));
    CHECK(threshold({}, 100000) == doctest::Approx(8e-5));
    CHECK(threshold({.densify_until_iter = 30000}, 100000) == doctest::Approx(8e-5));
    CHECK(threshold({.densify_until_iter = 15000 / 16}, 100000) == doctest::Approx(1.6e-4).epsilon(0.001));
    CHECK(threshold({.densify_until_iter = 30000}, 7000) == doctest::Approx(8e-5 * std::pow(15.0 / 7, 0.25)));
    CHECK(std::isfinite(threshold({.densify_until_iter = 0}, 7000)));
    CHECK(threshold({.densify_until_iter = 0, .densify_grad_threshold = 3e-4}, 7000) == 3e-4);
}

TEST_CASE("photos of more than 600,000 pixels raise the growth threshold, at most to its double") {
    const auto threshold = [](std::size_t pixels, const adaptive_config& config = {}) {
        return adaptive_schedule(config, {.iterations = 30000, .views = 1000, .pixels = 1000 * pixels})
            .growth_threshold();
    };
    CHECK(threshold(100000) == doctest::Approx(8e-5));
    CHECK(threshold(600000) == doctest::Approx(8e-5));
    CHECK(threshold(1350000) == doctest::Approx(1.2e-4));
    CHECK(threshold(12000000) == doctest::Approx(1.6e-4));
    CHECK(threshold(12000000, {.densify_grad_threshold = 3e-4}) == 3e-4);
}

TEST_CASE(
    "the penalty on opacities falls with the views, and is 0 for transparent photos, unless it is set") {
    gs::train::training_facts facts;
    facts.views = 25;
    CHECK(adaptive_schedule({}, facts).opacity_penalty() == 0.01);
    facts.views = 250;
    CHECK(adaptive_schedule({}, facts).opacity_penalty() == doctest::Approx(0.001));
    CHECK(adaptive_schedule({.opacity_penalty = 0}, facts).opacity_penalty() == 0);
    facts.transparent = true;
    CHECK(adaptive_schedule({}, facts).opacity_penalty() == 0);
    CHECK(adaptive_schedule({.opacity_penalty = 0.5}, facts).opacity_penalty() == 0.5);
}

TEST_CASE("pruning follows densification, half-way to the end at the latest") {
    adaptive_config config{.densify_from_iter = 400, .densify_until_iter = 600};
    const auto share = [](int iterations, bool transparent, int until = 100000) {
        return adaptive_schedule(
                   {.densify_until_iter = until < 100000 ? std::optional<int>(until) : std::nullopt},
                   {.iterations = iterations, .views = 20, .transparent = transparent})
            .share_to_prune();
    };
    CHECK(share(5000, true) == 0.2);
    CHECK(share(7000, true) == doctest::Approx(0.2));
    CHECK(share(15000, true) == doctest::Approx(1 - 0.8 * std::cbrt(3.5 / 7.5)));
    CHECK(share(100000, true) == 0.6);
    CHECK(share(30000, true, 29999) == 0.2);
    CHECK(share(30000, false) == 0.2);
    CHECK(adaptive_schedule(config, {.iterations = 1000}).share_to_prune() == 0.2);
    config.prune_share = 0;
    CHECK(adaptive_schedule(config, {.iterations = 1000, .views = 50}).prune_after() == 0);
    config.prune_share = 0.1;
    const adaptive_schedule few(config, {.iterations = 1000, .views = 50});
    CHECK(few.prune_after() == 650);
    CHECK(few.due(650));
    CHECK_FALSE(few.due(651));
    CHECK(few.wants(650));
    CHECK_FALSE(few.wants(651));
    CHECK(few.count_is_final_after() == 650);
    CHECK(adaptive_schedule(config, {.iterations = 1000, .views = 500}).prune_after() == 800);
}

TEST_CASE("nothing is pruned by default if nothing grows, or if densification lasts to the end") {
    const auto prune_after = [](const adaptive_config& config, int iterations) {
        return adaptive_schedule(config, {.iterations = iterations, .views = 50}).prune_after();
    };
    CHECK(prune_after({}, 1000) == 0);  // densification would begin when it ends
    CHECK(prune_after({}, 1100) == 0);  // and here it ends before its first time
    CHECK(prune_after({}, 1300) == 700);
    CHECK(prune_after({.densify_from_iter = 100}, 1000) == 550);
    CHECK(prune_after({.densify_from_iter = 100, .densify_until_iter = 1000}, 1000) == 0);
    CHECK(prune_after({.densify_from_iter = 100, .densify_until_iter = 0}, 1000) == 0);
    CHECK(prune_after({.densify_until_iter = 0, .prune_share = 0.3}, 1000) == 50);
}

TEST_CASE("the remaining densifications include the present one") {
    for (const auto& [from, interval, until] : {std::array{100, 50, 501}, {100, 50, 500}, {10, 7, 100}}) {
        const adaptive_schedule s(
            {.densify_from_iter = from, .densify_until_iter = until, .densification_interval = interval}, {});
        for (int now = 1; now < until; ++now) {
            int left = 0;
            for (int i = now; i < until; ++i) left += s.densifies(i) ? 1 : 0;
            CAPTURE(now);
            CHECK(s.densifications_from(now) == left);
        }
    }
}

TEST_CASE("densification, resets and hiding keep their intervals") {
    adaptive_config config{.densify_from_iter = 20,
                           .densify_until_iter = 900,
                           .densification_interval = 10,
                           .opacity_reset_interval = 30,
                           .prune_share = 0};
    const adaptive_schedule s(config, {.iterations = 1001, .views = 5});
    CHECK_FALSE(s.densifies(20));
    CHECK(s.densifies(30));
    CHECK_FALSE(s.densifies(35));
    CHECK(s.densifies(890));
    CHECK_FALSE(s.densifies(900));
    CHECK(s.due(30));
    CHECK_FALSE(s.due(35));
    CHECK(s.count_is_final_after() == 900);
    CHECK(s.wants(899));
    CHECK_FALSE(s.wants(900));
    CHECK(s.resets_opacity(30));
    CHECK_FALSE(s.resets_opacity(40));
    CHECK(s.resets_opacity(870));
    CHECK_FALSE(s.resets_opacity(900));
    CHECK(s.hides_near_cameras(30));
    CHECK_FALSE(s.hides_near_cameras(31));
    CHECK(s.hides_near_cameras(1000));
    CHECK(s.hides_near_cameras(1001));  // the last iteration
    config.densify_until_iter = 899;
    CHECK_FALSE(adaptive_schedule(config, {.iterations = 1001}).resets_opacity(870));
    config.densify_until_iter = 900;
    CHECK(adaptive_schedule(config, {.iterations = 1001, .white = true}).resets_opacity(20));
    config.densify_until_iter = 0;
    CHECK_FALSE(adaptive_schedule(config, {.iterations = 1001}).densifies(30));
    CHECK_FALSE(adaptive_schedule(config, {.iterations = 1001}).resets_opacity(30));
}
