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

double* values_of(render_case& q, gs::parameter p, std::size_t i) {
    const auto k = static_cast<std::size_t>(p);
    return q.parameters[k].data() + i * static_cast<std::size_t>(gs::parameter_width[k]);
}

void paint_photo(render_case& q, unsigned seed) {
    q.view.pixels = random_case(seed, 0, q.view.camera.width, q.view.camera.height, 0).view.pixels;
}

std::array<double, 4> turned(double angle, const glm::dvec3& axis) {
    const glm::dquat q = glm::angleAxis(angle, glm::normalize(axis));
    return {q.w, q.x, q.y, q.z};
}

void check_culled(const render_case& given) {
    render_case q = given;
    const render_case rest = without(q, victim);
    on_each_variant([&](const backend& b, accumulator how) {
        render_case r = rest;
        q.how = r.how = how;
        REQUIRE_FALSE(b.project(q)[victim].drawn);
        CHECK(harm(b.render(q), b.render(r), victim, is_loose(b, how)) == "");
    });
}

void check_drawn(const render_case& given, bool with_gradients) {
    render_case q = given;
    q.weights = off_thresholds(q, 1e-4);
    const render_result expected = reference().render(q);
    const std::vector<projected_splat> splats = reference().project(q);
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = how;
        const render_result a = b.render(q);
        const std::vector<projected_splat> drawn = b.project(q);
        for (std::size_t i = 0; i < drawn.size(); ++i) CHECK(drawn[i].drawn == splats[i].drawn);
        CHECK(all_finite(a));
        CHECK(distance(a, expected, q) <= 1e-3);
        if (with_gradients) CHECK(excess(a, expected) == "");
    });
}

}  // namespace hard_cases
