// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>

#include "training/schedule.hpp"
#include "training/training.hpp"

using gs::train::schedule;

TEST_CASE("rates of the positions fall a hundredfold, by the scene's extent") {
    schedule s;
    s.extent = 2;
    s.iterations = 30000;
    s.views = 1000;
    CHECK(s.rates_at(0)[0] == doctest::Approx(3.2e-4));
    CHECK(s.rates_at(15000)[0] == doctest::Approx(3.2e-5));
    CHECK(s.rates_at(30000)[0] == doctest::Approx(3.2e-6));
    CHECK(s.rates_at(1)[5] == doctest::Approx(s.rates_at(1)[4] / 10));
}

TEST_CASE("rates of the positions fall until twice the end of growth, if training lasts longer") {
    schedule s;
    s.iterations = 30000;
    s.views = 100;  // growth ends after 4,000 iterations
    CHECK(s.rates_at(4000)[0] == doctest::Approx(1.6e-5));
    CHECK(s.rates_at(8000)[0] == doctest::Approx(1.6e-6));
    CHECK(s.rates_at(29999)[0] == doctest::Approx(1.6e-6));
    s.iterations = 6000;  // growth ends after 3,000 iterations
    CHECK(s.rates_at(3000)[0] == doctest::Approx(1.6e-5));
    CHECK(s.rates_at(6000)[0] == doctest::Approx(1.6e-6));
}

TEST_CASE("the other rates fall to a tenth in the last fifth of the iterations") {
    schedule s;
    s.iterations = 1000;
    for (std::size_t p = 1; p < 8; ++p) {
        CHECK(s.rates_at(800)[p] == s.rates_at(1)[p]);
        CHECK(s.rates_at(900)[p] == doctest::Approx(s.rates_at(1)[p] * std::sqrt(0.1)));
        CHECK(s.rates_at(1000)[p] == doctest::Approx(s.rates_at(1)[p] / 10));
    }
}

TEST_CASE("photos with transparent parts have faster rates, and no dropout, unless they are set") {
    schedule opaque, cut_out;
    cut_out.transparent = true;
    CHECK(opaque.rates_at(7000)[0] == doctest::Approx(1.6e-6));
    CHECK(cut_out.rates_at(0)[0] == doctest::Approx(3.2e-4));
    CHECK(cut_out.rates_at(7000)[0] == doctest::Approx(8e-6));
    CHECK(cut_out.rates_at(1)[5] == doctest::Approx(cut_out.rates_at(1)[4] / 5));
    CHECK(opaque.dropout_share() == 0.05);
    CHECK(cut_out.dropout_share() == 0);
    cut_out.position_lr_init = cut_out.position_lr_final = 1e-3;
    cut_out.sh_lr = 2e-3;
    cut_out.dropout = 0.2;
    CHECK(cut_out.rates_at(3500)[0] == doctest::Approx(1e-3));
    CHECK(cut_out.rates_at(1)[5] == doctest::Approx(2e-3));
    CHECK(cut_out.dropout_share() == 0.2);
}

TEST_CASE("a degree of spherical harmonics every interval") {
    schedule s;
    s.sh_degree = 2;
    CHECK(s.sh_degree_at(499) == 0);
    CHECK(s.sh_degree_at(500) == 1);
    CHECK(s.sh_degree_at(1250) == 2);
    CHECK(s.sh_degree_at(6999) == 2);
}

TEST_CASE("images are downsampled less and less") {
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

TEST_CASE("photos are whole after three fifths of the iterations or later, or from the first of very few") {
    schedule s;
    s.iterations = 100;
    CHECK(s.downscales_at(60) == 1);
    CHECK(s.downscales_at(61) == 0);
    s.num_downscales = 3;
    CHECK(s.downscales_at(26) == 3);
    CHECK(s.downscales_at(78) == 1);
    CHECK(s.downscales_at(79) == 0);
    s.iterations = 1;
    CHECK(s.downscales_at(1) == 0);
}

TEST_CASE("photos are whole soon after growth ends, however long training is") {
    schedule s;
    s.iterations = 30000;
    CHECK(s.downscales_at(4200) == 1);
    CHECK(s.downscales_at(4201) == 0);
    s.views = 200;  // growth ends at 8000
    CHECK(s.downscales_at(9600) == 1);
    CHECK(s.downscales_at(9601) == 0);
}

TEST_CASE("rendered images are whole before growth ends") {
    schedule s;
    s.transparent = s.rendered = true;
    s.iterations = 30000;  // growth ends at 15000
    CHECK(s.downscales_at(6000) == 1);
    CHECK(s.downscales_at(6001) == 0);
    s.iterations = 100;
    s.num_downscales = 3;
    CHECK(s.downscales_at(42) == 1);
    CHECK(s.downscales_at(43) == 0);
}

TEST_CASE("large photos are halved more often, if enough iterations follow") {
    const auto halvings = [](int width, int height, int iterations) {
        gs::scene scene;
        scene.train.resize(2);
        scene.train[0].camera.width = scene.train[0].camera.height = 10;
        scene.train[1].camera.width = width;
        scene.train[1].camera.height = height;
        schedule s;
        s.iterations = iterations;
        return gs::train::default_downscales(scene, s);
    };
    CHECK(halvings(1, 1, 7000) == 1);
    CHECK(halvings(692, 692, 7000) == 1);
    CHECK(halvings(693, 693, 7000) == 2);
    CHECK(halvings(1385, 1385, 7000) == 2);
    CHECK(halvings(1386, 1386, 7000) == 3);
    CHECK(halvings(4000, 3000, 7000) == 3);
    CHECK(halvings(4000, 3000, 1) == 3);  // too few to begin with smaller photos
    CHECK(halvings(100000, 100000, 7000) == 3);
}

TEST_CASE("colors that depend on direction can learn more rarely") {
    schedule s;
    CHECK(s.updates_sh(1));
    s.sh_update_interval = 3;
    CHECK_FALSE(s.updates_sh(1));
    CHECK_FALSE(s.updates_sh(2));
    CHECK(s.updates_sh(3));
    CHECK_FALSE(s.updates_sh(4));
}

TEST_CASE("rates and intervals are the reference implementation's, and can be others") {
    schedule s;
    s.iterations = 30000;
    CHECK(s.rates_at(0)[0] == 1.6e-4f);
    CHECK(s.rates_at(30000)[0] == doctest::Approx(1.6e-6));
    CHECK(s.rates_at(0)[1] == 1e-2f);    // log scale
    CHECK(s.rates_at(0)[2] == 1e-3f);    // quaternion
    CHECK(s.rates_at(0)[3] == 2.5e-2f);  // opacity
    CHECK(s.rates_at(0)[4] == 2.5e-3f);  // color

    s.views = 1000;
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
