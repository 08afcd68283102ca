// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

#include "readers/load_scene.hpp"
#include "scene/observations.hpp"

namespace {

/// Returns the 3×3 pixels of a photo around each point, one point below the other.
gs::image patches_of(const gs::image& photo, const std::vector<gs::place_in_photo>& points) {
    gs::image patches{3, static_cast<int>(3 * points.size()), {}};
    for (const gs::place_in_photo& p : points)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const int pixel = (static_cast<int>(p.y) + dy) * photo.width + static_cast<int>(p.x) + dx;
                const auto first = photo.rgba.begin() + 4 * pixel;
                patches.rgba.insert(patches.rgba.end(), first, first + 4);
            }
    return patches;
}

}  // namespace

TEST_CASE("observations in patches are those in the photo") {
    gs::load_options from;
    from.data = "synthetic:alpha,views=3,points=7000";
    const gs::scene scene = gs::load_scene(from, {});
    gs::point_observer in_photos(scene), in_patches(scene);
    for (std::size_t v = 0; v < scene.train.size(); ++v) {
        const gs::view& view = scene.train[v];
        in_photos.observe(v, view.pixels, view.camera);
        const auto points = in_patches.in_sight(view.camera);
        in_patches.observe_patches(v, points, patches_of(view.pixels, points), view.camera);
    }
    const gs::observed_points expected = in_photos.observations(), found = in_patches.observations();
    REQUIRE(found.size() == expected.size());
    std::size_t count = 0;
    for (std::size_t p = 0; p < found.size(); ++p) {
        REQUIRE(found[p].size() == expected[p].size());
        for (std::size_t i = 0; i < found[p].size(); ++i, ++count) {
            CHECK(found[p][i].color == expected[p][i].color);
            CHECK(found[p][i].roughness == expected[p][i].roughness);
            CHECK(found[p][i].place == expected[p][i].place);
            CHECK(found[p][i].point == expected[p][i].point);
        }
    }
    CHECK(count > 1000);
}

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
