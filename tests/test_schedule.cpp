// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "train/schedule.hpp"

using gs::train::schedule;

TEST_CASE("rates of the positions fall a hundredfold, by the scene's extent") {
    schedule s;
    s.extent = 2;
    s.iterations = 30000;
    CHECK(s.rates_at(0)[0] == doctest::Approx(3.2e-4));
    CHECK(s.rates_at(15000)[0] == doctest::Approx(3.2e-5));
    CHECK(s.rates_at(30000)[0] == doctest::Approx(3.2e-6));
    CHECK(s.rates_at(1)[5] == doctest::Approx(s.rates_at(1)[4] / 20));
}

TEST_CASE("a degree of spherical harmonics every interval") {
    schedule s;
    s.sh_degree = 2;
    CHECK(s.sh_degree_at(999) == 0);
    CHECK(s.sh_degree_at(1000) == 1);
    CHECK(s.sh_degree_at(2500) == 2);
    CHECK(s.sh_degree_at(6999) == 2);
}

TEST_CASE("densification ends half-way, and opacities are reset only while it lasts") {
    schedule s;
    s.iterations = 7000;
    CHECK_FALSE(s.densifies(500));
    CHECK(s.densifies(600));
    CHECK_FALSE(s.densifies(650));
    CHECK(s.densifies(3400));
    CHECK_FALSE(s.densifies(3500));
    CHECK(s.resets_opacity(3000));
    CHECK_FALSE(s.resets_opacity(6000));
    CHECK_FALSE(s.resets_opacity(500));
    s.white = true;
    CHECK(s.resets_opacity(500));
    s.iterations = 100000;
    CHECK(s.densify_until() == 15000);
}
