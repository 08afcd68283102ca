// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "bounds.hpp"
#include "cases.hpp"
#include "healthy.hpp"
#include "table.hpp"

namespace hard_cases {

double* values_of(question& q, gs::parameter p, std::size_t i) {
    const auto k = static_cast<std::size_t>(p);
    return q.parameters[k].data() + i * static_cast<std::size_t>(gs::parameter_width[k]);
}

void paint_photo(question& q, unsigned seed) {
    q.view.pixels = random_question(seed, 0, q.view.camera.width, q.view.camera.height, 0).view.pixels;
}

std::array<double, 4> turned(double angle, const glm::dvec3& axis) {
    const glm::dquat q = glm::angleAxis(angle, glm::normalize(axis));
    return {q.w, q.x, q.y, q.z};
}

void check_culled(const question& asked) {
    question q = asked;
    const question rest = without(q, victim);
    on_each_variant([&](const backend& b, accumulator how) {
        question r = rest;
        q.how = r.how = how;
        REQUIRE_FALSE(b.project(q)[victim].drawn);
        CHECK(harm(b.ask(q), b.ask(r), victim, is_loose(b, how)) == "");
    });
}

void check_drawn(const question& asked, bool with_gradients) {
    question q = asked;
    q.weights = off_thresholds(q, 1e-4);
    const answer expected = reference().ask(q);
    const std::vector<projected_splat> splats = reference().project(q);
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = how;
        const answer a = b.ask(q);
        const std::vector<projected_splat> drawn = b.project(q);
        for (std::size_t i = 0; i < drawn.size(); ++i) CHECK(drawn[i].drawn == splats[i].drawn);
        CHECK(all_finite(a));
        CHECK(distance(a, expected, q) <= 1e-3);
        if (with_gradients) CHECK(excess(a, expected) == "");
    });
}

}  // namespace hard_cases
