// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "bounds.hpp"
#include "cases.hpp"
#include "checks.hpp"
#include "differences.hpp"
#include "healthy.hpp"
#include "table.hpp"

using namespace hard_cases;

namespace {

constexpr double pi = std::numbers::pi;

/// A panorama from the origin.
render_case empty_panorama(int width, int height) {
    render_case q = empty_case(width, height);
    q.view.camera = gs::camera::panorama(width, height);
    return q;
}

gaussian gaussian_at(double longitude, double latitude, double size) {
    gaussian g;
    g.mean = 3.0 * glm::dvec3(std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                              std::cos(latitude) * std::cos(longitude));
    g.log_scale = std::log(size) + glm::dvec3(0.2, -0.3, 0.1);
    g.quaternion = turned(0.7, {0.3, 1, -0.4});
    g.opacity = 0.5;
    g.color = {0.9, 0.6, 0.2};
    return g;
}

}  // namespace

TEST_CASE("case 28: the seam and the poles of a panorama") {
    SUBCASE("at the seam, near a pole and behind the camera: drawn") {
        for (const double longitude : {0.3, pi - 0.02, 0.02 - pi, pi - 1e-6})
            for (const double from_pole : {pi / 2, 0.9, 0.2, 0.03})
                for (const double size : {0.05, 0.5}) {
                    CAPTURE(longitude);
                    CAPTURE(from_pole);
                    CAPTURE(size);
                    render_case q = empty_panorama(50, 24);
                    paint_photo(q, 28);
                    add(q, gaussian_at(longitude, from_pole - pi / 2, size));
                    gaussian behind = gaussian_at(longitude + 0.1, pi / 2 - from_pole, size);
                    behind.mean *= 1.2;
                    add(q, behind);
                    const verdict v = check_by_differences(q, {0, 1}, 28);
                    CHECK_MESSAGE(v.wrong == 0, v.first_wrong);
                    CHECK(v.straddling <= 1);
                    check_drawn(q, true);
                }
    }
    SUBCASE("at a pole: drawn across the whole image, with finite gradients") {
        for (const double up : {-1.0, 1.0})
            for (const double aside : {0.0, -0.0, 1e-30, 1e-7, 1e-5})
                for (const double size : {1e-3, 0.3, 10.0}) {
                    CAPTURE(up);
                    CAPTURE(aside);
                    CAPTURE(size);
                    render_case q = empty_panorama(40, 20);
                    paint_photo(q, 29);
                    gaussian g = gaussian_at(0, 0, size);
                    g.mean = {aside, 2 * up, -aside};
                    add(q, g);
                    check_drawn(q, false);
                    const render_result a = reference().render(q);
                    const std::size_t row = up < 0 ? 0 : 19;
                    for (std::size_t x = 0; x < 40; ++x) CHECK(a.render[row * 40 + x] > 0.01);
                }
    }
    SUBCASE("at the center of the camera: culled") {
        for (const double off : {0.0, 1e-30, 0.01}) {
            render_case q = faint_crowd(28, crowd);
            q.view.camera = gs::camera::panorama(8, 4);
            double* mean = values_of(q, gs::parameter::mean, victim);
            mean[0] = mean[1] = 0;
            mean[2] = off;
            check_culled(q);
        }
    }
    SUBCASE("a turn of the camera about its axis moves the image around, and changes nothing else") {
        const std::size_t width = 50, height = 24;
        render_case q = random_case(28, 60, static_cast<int>(width), static_cast<int>(height), 0);
        take_panorama(q);
        const glm::dmat3 ahead = q.view.camera.rotation;
        const glm::dvec3 center = q.view.camera.center();
        const std::vector<double> first = reference().render(q).render;
        for (const std::size_t columns : {std::size_t{1}, std::size_t{17}, std::size_t{25}}) {
            CAPTURE(columns);
            const double angle = 2 * pi * static_cast<double>(columns) / static_cast<double>(width);
            q.view.camera.rotation = glm::mat3_cast(glm::angleAxis(angle, glm::dvec3(0, 1, 0))) * ahead;
            q.view.camera.translation = -(q.view.camera.rotation * center);
            const std::vector<double> turned = reference().render(q).render;
            std::vector<double> back(turned.size());
            for (std::size_t i = 0; i < turned.size(); ++i)
                back[i] = turned[i / width * width + (i % width + columns) % width];
            CHECK(distance(first, back) < 1e-9);
            CHECK(distance(first, turned) > 0.1);
        }
    }
}
