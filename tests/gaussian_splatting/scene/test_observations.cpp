// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <glm/geometric.hpp>

#include "readers/load_scene.hpp"
#include "scene/observations.hpp"

TEST_CASE("observations name their points, also if only a sample of the points is observed") {
    gs::load_options from;
    from.data = "synthetic:spheres,views=5,points=7000";
    const gs::scene scene = gs::load_scene(from, {});
    std::size_t count = 0;
    for (const auto& seen : gs::observe_points(scene))
        for (const gs::observation& o : seen) {
            const glm::dvec3 ray =
                glm::normalize(scene.points[o.point].position - scene.train[o.view].camera.center());
            CHECK(glm::dot(ray, glm::dvec3(o.direction)) > 1 - 1e-6);
            ++count;
        }
    CHECK(count > 1000);
}
