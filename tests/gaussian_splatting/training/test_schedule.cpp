// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>

#include "training/schedule.hpp"

using gs::train::schedule;

TEST_CASE("rates of the positions fall a hundredfold, by the scene's extent") {
    schedule s;
    s.extent = 2;
    s.iterations = 30000;
    CHECK(s.rates_at(0)[0] == doctest::Approx(3.2e-4));
    CHECK(s.rates_at(15000)[0] == doctest::Approx(3.2e-5));
    CHECK(s.rates_at(30000)[0] == doctest::Approx(3.2e-6));
    CHECK(s.rates_at(1)[5] == doctest::Approx(s.rates_at(1)[4] / 10));
}

TEST_CASE("the weight of depths falls a hundredfold") {
    schedule s;
    s.iterations = 100;
    CHECK(s.depth_weight_at(0) == 1);
    CHECK(s.depth_weight_at(50) == doctest::Approx(0.1));
    CHECK(s.depth_weight_at(100) == doctest::Approx(0.01));
}

TEST_CASE("a degree of spherical harmonics every interval") {
    schedule s;
    s.sh_degree = 2;
    CHECK(s.sh_degree_at(499) == 0);
    CHECK(s.sh_degree_at(500) == 1);
    CHECK(s.sh_degree_at(1250) == 2);
    CHECK(s.sh_degree_at(6999) == 2);
}

TEST_CASE("photos are shrunk less and less") {
    schedule s;
    s.resolution_schedule = 10;
    CHECK(s.downscales_at(10) == 1);
    CHECK(s.downscales_at(11) == 0);
    s.num_downscales = 0;
    CHECK(s.downscales_at(1) == 0);
    s.num_downscales = 2;
    CHECK(s.downscales_at(1) == 2);
    CHECK(s.downscales_at(10) == 2);
    CHECK(s.downscales_at(11) == 1);
    CHECK(s.downscales_at(20) == 1);
    CHECK(s.downscales_at(21) == 0);
    CHECK(s.downscales_at(1000) == 0);
}

TEST_CASE("photos are whole after a fifth of the iterations, or from the first of very few") {
    schedule s;
    s.iterations = 100;
    CHECK(s.downscales_at(20) == 1);
    CHECK(s.downscales_at(21) == 0);
    s.num_downscales = 3;
    CHECK(s.downscales_at(14) == 3);
    CHECK(s.downscales_at(42) == 1);
    CHECK(s.downscales_at(43) == 0);
    s.iterations = 6;
    CHECK(s.downscales_at(1) == 0);
}

TEST_CASE("colours that depend on direction can learn more rarely") {
    schedule s;
    CHECK(s.updates_sh(1));
    s.sh_update_interval = 3;
    CHECK_FALSE(s.updates_sh(1));
    CHECK_FALSE(s.updates_sh(2));
    CHECK(s.updates_sh(3));
    CHECK_FALSE(s.updates_sh(4));
}

TEST_CASE("densification ends half-way, and opacities are reset only when an interval of it is left") {
    schedule s;
    s.iterations = 7000;
    CHECK_FALSE(s.densifies(500));
    CHECK(s.densifies(600));
    CHECK_FALSE(s.densifies(650));
    CHECK(s.densifies(3400));
    CHECK_FALSE(s.densifies(3500));
    CHECK_FALSE(s.resets_opacity(3000));
    CHECK_FALSE(s.resets_opacity(500));
    s.white = true;
    CHECK(s.resets_opacity(500));
    s.iterations = 100000;
    CHECK(s.densify_until() == 15000);
    CHECK(s.resets_opacity(3000));
    CHECK(s.resets_opacity(12000));
    CHECK_FALSE(s.resets_opacity(15000));
}

TEST_CASE("the shorter densification is, the larger are the gradients that grow, unless one is said") {
    schedule s;
    s.iterations = 30000;
    CHECK(s.growth_threshold() == doctest::Approx(8e-5));
    s.iterations = 100000;
    CHECK(s.growth_threshold() == doctest::Approx(8e-5));
    s.densify_until_iter = 30000;
    CHECK(s.growth_threshold() == doctest::Approx(8e-5));
    s.densify_until_iter = 15000 / 16;
    CHECK(s.growth_threshold() == doctest::Approx(1.6e-4).epsilon(0.001));
    s.iterations = 7000;
    s.densify_until_iter = 30000;
    CHECK(s.densify_until() == 7000);
    CHECK(s.growth_threshold() == doctest::Approx(8e-5 * std::pow(15.0 / 7, 0.25)));
    CHECK_FALSE(s.resets_opacity(6000));
    s.densify_until_iter = 0;
    CHECK(std::isfinite(s.growth_threshold()));
    s.densify_grad_threshold = 3e-4;
    CHECK(s.growth_threshold() == 3e-4);
}

TEST_CASE("pruning follows densification, half-way to the end at the latest") {
    schedule s;
    s.iterations = 1000;
    s.densify_until_iter = 600;
    s.densify_from_iter = 400;
    CHECK(s.share_to_prune() == 0.2);
    s.prune_share = 0;
    CHECK(s.prune_after(50) == 0);
    s.prune_share = 0.1;
    CHECK(s.prune_after(50) == 650);
    CHECK(s.watches(650, 50));
    CHECK_FALSE(s.watches(651, 50));
    CHECK(s.prune_after(500) == 800);
}

TEST_CASE("where nothing grows, or until the end, nothing is pruned, unless it is said") {
    schedule s;
    s.iterations = 1000;
    CHECK(s.prune_after(50) == 0);  // densification would begin as it ends
    s.iterations = 1100;            // and here, before its first time
    CHECK(s.prune_after(50) == 0);
    s.iterations = 1300;
    CHECK(s.prune_after(50) == 700);
    s.iterations = 1000;
    s.densify_from_iter = 100;
    CHECK(s.prune_after(50) == 550);
    s.densify_until_iter = 1000;
    CHECK(s.prune_after(50) == 0);
    s.densify_until_iter = 0;
    CHECK(s.prune_after(50) == 0);
    s.prune_share = 0.3;
    CHECK(s.prune_after(50) == 50);
}

TEST_CASE("how many densifications are left, this one among them") {
    schedule s;
    for (const auto& [from, interval, until] : {std::array{100, 50, 501}, {100, 50, 500}, {10, 7, 100}}) {
        s.densify_from_iter = from;
        s.densification_interval = interval;
        s.densify_until_iter = until;
        for (int now = 1; now < until; ++now) {
            int left = 0;
            for (int i = now; i < until; ++i) left += s.densifies(i) ? 1 : 0;
            CAPTURE(now);
            CHECK(s.densifications_from(now) == left);
        }
    }
}

TEST_CASE("rates and intervals are the reference implementation's, and can be others") {
    schedule s;
    s.iterations = 30000;
    CHECK(s.rates_at(0)[0] == 1.6e-4f);
    CHECK(s.rates_at(30000)[0] == doctest::Approx(1.6e-6));
    CHECK(s.rates_at(0)[1] == 1e-2f);    // log scale
    CHECK(s.rates_at(0)[2] == 1e-3f);    // quaternion
    CHECK(s.rates_at(0)[3] == 2.5e-2f);  // opacity
    CHECK(s.rates_at(0)[4] == 2.5e-3f);  // colour
    CHECK(s.densify_until() == 15000);

    s.position_lr_init = 1e-2;
    s.position_lr_final = 1e-4;
    s.scaling_lr = 1;
    s.rotation_lr = 2;
    s.opacity_lr = 3;
    s.feature_lr = 40;
    CHECK(s.rates_at(15000)[0] == doctest::Approx(1e-3));
    CHECK(s.rates_at(30001)[0] == doctest::Approx(1e-4));
    CHECK(s.rates_at(7) == std::array<float, 8>{s.rates_at(7)[0], 1, 2, 3, 40, 4, 4, 4});
    s.sh_lr = 5;
    CHECK(s.rates_at(7) == std::array<float, 8>{s.rates_at(7)[0], 1, 2, 3, 40, 5, 5, 5});
}

TEST_CASE("densification and resets keep to their intervals") {
    schedule s;
    s.iterations = 1000;
    s.densify_from_iter = 20;
    s.densification_interval = 10;
    s.densify_until_iter = 900;
    s.prune_share = 0;
    s.opacity_reset_interval = 30;
    CHECK_FALSE(s.densifies(20));
    CHECK(s.densifies(30));
    CHECK_FALSE(s.densifies(35));
    CHECK(s.densifies(890));
    CHECK_FALSE(s.densifies(900));
    CHECK(s.watches(899, 5));
    CHECK_FALSE(s.watches(900, 5));
    CHECK(s.resets_opacity(30));
    CHECK_FALSE(s.resets_opacity(40));
    CHECK(s.resets_opacity(870));
    CHECK_FALSE(s.resets_opacity(900));
    s.densify_until_iter = 899;
    CHECK_FALSE(s.resets_opacity(870));
    s.densify_until_iter = 900;
    s.white = true;
    CHECK(s.resets_opacity(20));
    s.densify_until_iter = 0;
    CHECK_FALSE(s.densifies(30));
    CHECK_FALSE(s.resets_opacity(30));
}
