// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "random_question.hpp"

namespace {

using probe::answer;
using probe::question;

constexpr const char* names[] = {"mean", "log_scale", "quaternion", "opacity", "sh0", "sh1", "sh2", "sh3"};

/// dL/dx by central differences.
double difference(question& q, double& x) {
    constexpr double step = 1e-6;
    const double at = x;
    x = at + step;
    const double above = probe::ask_reference(q).loss;
    x = at - step;
    const double below = probe::ask_reference(q).loss;
    x = at;
    return (above - below) / (2 * step);
}

void check_by_differences(question q) {
    const answer a = probe::ask_reference(q);
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        double largest = 0;
        for (const double g : a.gradients[p]) largest = std::max(largest, std::abs(g));
        for (std::size_t i = 0; i < q.parameters[p].size(); ++i) {
            CAPTURE(names[p]);
            CAPTURE(i);
            const double expected = difference(q, q.parameters[p][i]);
            // Relative 1e-5; and 5e-10 for the rounding (1e-15) of two losses over 2e-6.
            CHECK(a.gradients[p][i] == doctest::Approx(expected).epsilon(1e-5).scale(largest * 1e-2 + 5e-5));
        }
    }
}

/// numerics.md's bounds: 1e-3 relative and 1e-5 of the largest, cosine 0.99999, signed bias 1e-4.
void check_against_reference(const answer& got, const answer& reference) {
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        CAPTURE(names[p]);
        const auto& a = got.gradients[p];
        const auto& b = reference.gradients[p];
        REQUIRE(a.size() == b.size());
        if (a.empty()) continue;
        double largest = 0, ab = 0, aa = 0, bb = 0, bias = 0, mass = 0;
        for (const double g : b) largest = std::max(largest, std::abs(g));
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (!(std::abs(a[i] - b[i]) <= 1e-3 * std::abs(b[i]) + 1e-5 * largest)) ++wrong;
            ab += a[i] * b[i];
            aa += a[i] * a[i];
            bb += b[i] * b[i];
            bias += a[i] - b[i];
            mass += std::abs(b[i]);
        }
        CHECK(wrong == 0);
        CHECK(ab >= 0.99999 * std::sqrt(aa * bb));
        CHECK(std::abs(bias) <= 1e-4 * mass);
    }
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double square = 0, mass = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
        mass += b[i] * b[i];
    }
    return mass > 0 ? std::sqrt(square / mass) : std::sqrt(square);
}

void check_picture(const answer& got, const answer& reference) {
    REQUIRE(got.picture.size() == reference.picture.size());
    CHECK(distance(got.picture, reference.picture) < 1e-5);
    CHECK(got.loss == doctest::Approx(reference.loss).epsilon(1e-5));
}

template <class Ask>
void check_device(const Ask& ask) {
    for (unsigned seed = 100; seed < 120; ++seed) {
        CAPTURE(seed);
        const question q = probe::random_question(seed, 1 + seed % 7 * 8, 33, 47, static_cast<int>(seed % 4));
        const answer reference = probe::ask_reference(q), got = ask(q);
        check_picture(got, reference);
        check_against_reference(got, reference);
    }
}

/// Every way of adding up gradients gives the same ones, to float's noise.
template <class Ask>
void check_policies_agree(const Ask& ask) {
    question q = probe::random_question(7, 300, 64, 48, 3);
    q.policy = gs::gradient_policy::scatter;
    const answer ours = ask(q);
    for (const auto policy :
         {gs::gradient_policy::per_lane, gs::gradient_policy::reduce, gs::gradient_policy::reduce_skip}) {
        CAPTURE(gs::gradient_policy_names[static_cast<std::size_t>(policy)]);
        q.policy = policy;
        const answer theirs = ask(q);
        for (std::size_t p = 0; p < gs::parameter_count; ++p) {
            CAPTURE(names[p]);
            CHECK(distance(theirs.gradients[p], ours.gradients[p]) < 1e-5);
        }
    }
}

}  // namespace

TEST_CASE("the reference's gradients are those of central differences") {
    SUBCASE("one Gaussian") { check_by_differences(probe::random_question(1, 1, 8, 8, 3)); }
    SUBCASE("a few") {
        for (unsigned seed = 2; seed < 6; ++seed) {
            CAPTURE(seed);
            check_by_differences(probe::random_question(seed, 6, 17, 13, 3));
        }
    }
    SUBCASE("a crowd, several tiles") { check_by_differences(probe::random_question(6, 30, 33, 20, 1)); }
    SUBCASE("opaque ones: alpha is capped, pixels end early") {
        question q = probe::random_question(7, 12, 16, 16, 0);
        for (double& o : q.parameters[3]) o = 7;
        check_by_differences(q);
    }
    SUBCASE("far outside the picture, where the Jacobian is clamped") {
        question q = probe::random_question(8, 1, 16, 16, 0);
        q.view.camera.rotation = glm::dmat3(1);
        q.view.camera.translation = glm::dvec3(0);
        const double limit = (1.15 * 16 - q.view.camera.cx) / q.view.camera.fx;
        q.parameters[0] = {2 * limit * 2, 0.1, 2};  // x/z at twice the limit
        q.parameters[1] = {0.3, 0.1, -0.2};
        const answer a = probe::ask_reference(q);
        REQUIRE(std::abs(a.gradients[0][0]) > 1e-9);  // it is drawn
        check_by_differences(q);
    }
}

TEST_CASE("nothing to draw is the background, and no gradient") {
    question q = probe::random_question(9, 3, 20, 10, 1);
    SUBCASE("all behind the camera") { q.view.camera.translation = glm::dvec3(0, 0, -9); }
    SUBCASE("all transparent") { q.parameters[3].assign(3, -20.0); }
    SUBCASE("no Gaussians") {
        for (auto& p : q.parameters) p.clear();
    }
    for (const answer& a : {probe::ask_reference(q), probe::ask_lanes(q)}) {
        for (std::size_t i = 0; i < a.picture.size(); ++i)
            CHECK(a.picture[i] == static_cast<double>(q.background[i / (a.picture.size() / 3)]));
        for (const auto& gradients : a.gradients)
            for (const double g : gradients) CHECK(g == 0.0);
    }
}

TEST_CASE("the fast emulator agrees with the reference") { check_device(probe::ask_lanes); }

TEST_CASE("the fast emulator's gradient policies agree") { check_policies_agree(probe::ask_lanes); }

#if defined(WARPAGG_TEST_CUDA)
TEST_CASE("the GPU agrees with the reference") { check_device(probe::ask_cuda); }

TEST_CASE("the GPU's gradient policies agree") { check_policies_agree(probe::ask_cuda); }

TEST_CASE("the GPU draws nothing where there is nothing") {
    question q = probe::random_question(9, 3, 20, 10, 1);
    q.view.camera.translation = glm::dvec3(0, 0, -9);
    const answer a = probe::ask_cuda(q);
    for (std::size_t i = 0; i < a.picture.size(); ++i)
        CHECK(a.picture[i] == static_cast<double>(q.background[i / (a.picture.size() / 3)]));
}
#endif
