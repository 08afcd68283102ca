// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <string>

#include "core/iteration_plan.hpp"

using gs::iteration_plan;

TEST_CASE("iteration plan: without corrections, progress and milestones are shares of the iterations") {
    for (const int iterations : {1, 2, 5, 7, 83, 500, 7000, 7001, 30000, 9999999}) {
        CAPTURE(iterations);
        const iteration_plan plan(iterations);
        CHECK(plan.last() == iterations);
        CHECK(plan.progress(0) == 0);
        CHECK(plan.progress(iterations / 3) == static_cast<double>(iterations / 3) / iterations);
        CHECK(plan.progress(iterations) == 1);
        CHECK(plan.progress(iterations + 1) == 1);
        for (int part = 2; part <= 12; ++part) CHECK(plan.milestone(1.0 / part) == iterations / part);
    }
}

TEST_CASE("iteration plan: progress is continuous across a correction and ends at 1") {
    iteration_plan plan(100);
    plan.correct(40, 60);
    CHECK(plan.progress(30) == doctest::Approx(0.3));
    CHECK(plan.progress(40) == doctest::Approx(0.4));
    CHECK(plan.progress(41) == doctest::Approx(0.43));
    CHECK(plan.progress(60) == 1);
    plan.correct(50, 250);
    CHECK(plan.progress(50) == doctest::Approx(0.7));
    CHECK(plan.progress(150) == doctest::Approx(0.85));
    CHECK(plan.progress(250) == 1);
}

TEST_CASE("iteration plan: a correction moves future milestones and keeps passed ones") {
    iteration_plan plan(100);
    CHECK(plan.milestone(0.5) == 50);
    plan.correct(40, 60);
    CHECK(plan.milestone(0.2) == 20);
    CHECK(plan.milestone(0.4) == 40);
    CHECK(plan.milestone(0.5) == 43);
    plan.correct(50, 250);
    CHECK(plan.milestone(0.5) == 43);
    CHECK(plan.milestone(0.85) == 150);
    iteration_plan ends(1000);
    ends.correct(499, 501);
    CHECK(ends.milestone(0.5) == 500);  // not missed: it is after the correction
}

TEST_CASE("iteration plan: copies share a correction, and the first iterations of a plan are its own") {
    iteration_plan plan(100);
    const iteration_plan copy = plan;
    plan.correct(40, 60);
    CHECK(copy.last() == 60);
    plan.correct(50, 70);
    iteration_plan first = plan.first_iterations(40);
    CHECK(first.last() == 60);
    CHECK(first.milestone(0.2) == 20);
    first.correct(45, 90);
    CHECK(plan.last() == 70);
    CHECK(plan.first_iterations(39) == iteration_plan(100));
    CHECK(plan.correction_after(50) == 70);
    CHECK_FALSE(plan.correction_after(0));
    CHECK_FALSE(plan.correction_after(41));
    first.replace(plan);
    CHECK(first == plan);
}

TEST_CASE("iteration plan: text is read as it is written, and other texts are refused") {
    for (const char* text : {"1", "7000", "7000,100:6500", "7000,100:6500,6499:6500", "5,5:8"}) {
        CAPTURE(std::string(text));
        const auto plan = iteration_plan::parse(text, 7000);
        REQUIRE(plan);
        CHECK(plan->text() == text);
        CHECK(plan->is_corrected() == (std::string(text).find(':') != std::string::npos));
    }
    for (const char* text :
         {"", "0", "-1", "7001", "5.5", "many", "7000,", "7000,100", "7000,100:", "7000,0:5", "7000,100:100",
          "7000,100:7001", "700,701:702", "7000,100:6500,100:6000", "7000,100:200,201:300", "7000 ",
          "7000,9:10x", "99999999999999999999"}) {
        CAPTURE(std::string(text));
        CHECK_FALSE(iteration_plan::parse(text, 7000));
    }
}
