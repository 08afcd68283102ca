// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cfloat>
#include <cmath>
#include <limits>

#include "bounds.hpp"
#include "cases.hpp"
#include "checks.hpp"
#include "differences.hpp"
#include "healthy.hpp"
#include "table.hpp"

using namespace hard_cases;

TEST_CASE("case 8: far outside the image, where the Jacobian of the projection is held") {
    for (const auto& [side_x, side_y] :
         {std::pair{2.0, 0.02}, {-2.0, 0.02}, {0.05, 2.0}, {0.05, -2.0}, {2.0, -2.0}}) {
        CAPTURE(side_x);
        CAPTURE(side_y);
        render_case q = random_case(8, 1, 16, 16, 0);
        q.view.camera.rotation = glm::dmat3(1);
        q.view.camera.translation = glm::dvec3(0);
        // Twice the bound on either side: the image and 15 % of it.
        const gs::camera& c = q.view.camera;
        const double limit_x = (side_x < 0 ? 0.15 * 16 + c.cx : 1.15 * 16 - c.cx) / c.fx,
                     limit_y = (side_y < 0 ? 0.15 * 16 + c.cy : 1.15 * 16 - c.cy) / c.fy;
        q.parameters[0] = {side_x * limit_x * 2, side_y * limit_y * 2, 2};
        q.parameters[1] = {0.3, 0.1, -0.2};
        q.parameters[3] = {2};
        for (double& x : q.parameters[0]) x = static_cast<float>(x);
        const render_result exact = reference().render(q);
        REQUIRE(std::abs(exact.gradients[0][0]) > 1e-6);
        const verdict v = check_by_differences(q, {0}, 8);
        CHECK_MESSAGE(v.wrong == 0, v.first_wrong);
        CHECK(v.straddling == 0);
        check_drawn(q, true);
    }
}

TEST_CASE("case 9: needles, flat ones, and what is not a number") {
    SUBCASE("needles of aspect 1e6, and flat ones on edge: drawn") {
        // Standard deviations in the world; the image has 16 pixels a unit at their depth. How a needle's
        // image moves when it turns is as many times less certain as it is longer than wide: its gradients
        // are finite, and no more is asked of them.
        struct shape {
            glm::dvec3 scale;
            bool needle;
        };
        const shape shapes[] = {{{2e4, 0.02, 0.02}, true}, {{1e6, 1, 1}, true},
                                {{30, 3e-5, 3e-5}, true},  {{1, 1e-6, 1e-6}, true},
                                {{1e3, 1e3, 1e-3}, true},  {{1e5, 1e5, 1e-25}, true},
                                {{1, 1, 1e-30}, false},    {{1e-6, 1e-6, 1e-12}, false}};
        for (const auto& [scale, needle] : shapes)
            for (const double angle : {0.0, 0.3, 1.2}) {
                CAPTURE(scale.x);
                CAPTURE(scale.z);
                CAPTURE(angle);
                render_case q = empty_case(64, 48);
                paint_photo(q, 9);
                gaussian g;
                g.mean = {0.13, -0.21, 4};
                g.log_scale = glm::log(scale);
                g.quaternion = turned(angle, {angle > 1 ? 0.5 : 0, angle > 1 ? 1 : 0, 1});
                g.opacity = 1;
                g.color = {0.9, 0.5, 0.2};
                add(q, g);
                check_drawn(q, !needle);
            }
        SUBCASE("and a plane seen from its edge") {
            render_case q = empty_case(64, 48);
            paint_photo(q, 10);
            gaussian g;
            g.log_scale = {1, 1, -60};
            g.quaternion = turned(std::acos(-1.0) / 2, {0.3, 1, 0});
            add(q, g);
            check_drawn(q, false);
        }
    }
    SUBCASE("NaN in any parameter: culled, and nobody else changes by a bit") {
        const render_case healthy = faint_crowd(9, crowd);
        for (std::size_t p = 0; p < gs::parameter_count; ++p)
            for (const int k : {0, gs::parameter_width[p] - 1}) {
                CAPTURE(parameter_names[p]);
                render_case q = healthy;
                values_of(q, static_cast<gs::parameter>(p), victim)[k] = not_a_number;
                check_culled(q);
            }
    }
}

TEST_CASE("case 10: a quaternion of no length, and of any") {
    SUBCASE("zero is culled") {
        for (const double zero : {0.0, -0.0}) {
            render_case q = faint_crowd(10, crowd);
            for (std::size_t k = 0; k < 4; ++k) values_of(q, gs::parameter::quaternion, victim)[k] = zero;
            check_culled(q);
        }
    }
    SUBCASE("the length changes nothing") {
        render_case unit = random_case(11, 5, 24, 20, 1);
        unit.weights = off_thresholds(unit, 1e-4);
        const render_result exact = reference().render(unit);
        for (const double scale : {1e-36, 1e-20, 0x1p-60, 0x1p60, 1e20, 1e38}) {
            CAPTURE(scale);
            render_case q = unit;
            for (double& x : q.parameters[2]) x *= scale;
            on_each_variant([&](const backend& b, accumulator how) {
                q.how = how;
                render_result a = b.render(q);
                CHECK(distance(a, exact, q) < 1e-5);
                // Lengths at the ends of the range have gradients beyond it.
                if (scale > 1e-36 && scale < 1e38)
                    for (double& g : a.gradients[2]) g *= scale;
                else
                    a.gradients[2] = exact.gradients[2];
                CHECK(excess(a, exact) == "");
            });
        }
    }
}

TEST_CASE("case 11: huge and tiny scales") {
    render_case healthy = faint_crowd(11, crowd);
    SUBCASE("from exp(-30) to exp(40), and beyond: drawn") {
        for (const double s :
             {-static_cast<double>(FLT_MAX), -120.0, -30.0, -10.0, 0.0, 10.0, 25.0, 40.0, 50.0})
            for (const bool all : {true, false}) {
                CAPTURE(s);
                CAPTURE(all);
                render_case q = healthy;
                double* mean = values_of(q, gs::parameter::mean, victim);
                for (std::size_t k = 0; k < 3; ++k) mean[k] = 0;  // before the camera
                double* scale = values_of(q, gs::parameter::log_scale, victim);
                for (std::size_t k = 0; k < (all ? 3 : 1); ++k) scale[k] = s;
                REQUIRE(reference().project(q)[victim].drawn);
                check_drawn(q, false);
            }
    }
    SUBCASE("exp(45) along the image's rows, or its columns: drawn") {
        for (const int axis : {0, 1}) {
            CAPTURE(axis);
            render_case q = empty_case(40, 24);
            gaussian g;
            g.log_scale = glm::dvec3(-3);
            g.log_scale[axis] = 45;
            add(q, g);
            check_drawn(q, false);
        }
    }
    SUBCASE("exp(120), which no float holds: culled") {
        for (std::size_t k = 0; k < 3; ++k) {
            CAPTURE(k);
            render_case q = healthy;
            values_of(q, gs::parameter::log_scale, victim)[k] = 120;
            check_culled(q);
        }
    }
}

TEST_CASE("case 12: an infinite scale harms nobody else") {
    for (const double s : {infinity, 1e30, static_cast<double>(FLT_MAX), 89.0})
        for (const bool all : {true, false}) {
            CAPTURE(s);
            CAPTURE(all);
            render_case q = faint_crowd(12, crowd);
            for (std::size_t k = 0; k < (all ? 3 : 1); ++k)
                values_of(q, gs::parameter::log_scale, victim)[k] = s;
            check_culled(q);
        }
}

TEST_CASE("case 19: a scale of 1e-4 is drawn through the pixel's filter, but not with antialiasing") {
    for (const double offset : {0.0, 0.03}) {
        render_case q = empty_case(16, 12);
        paint_photo(q, 19);
        for (int i = 0; i < 4; ++i) {
            gaussian g;
            g.mean = {offset + 0.4 * i, 0.3 - 0.2 * i, 4 + 0.5 * i};
            g.log_scale = glm::log(glm::dvec3(1e-4, 2e-4, 5e-5));
            g.quaternion = turned(0.4 * i, {1, 2, 3});
            g.opacity = i - 1;
            add(q, g);
        }
        check_drawn(q, true);
        q.effects.antialiasing = true;  // each has a millionth of a pixel's light at most
        for (const backend& b : backends()) {
            CAPTURE(b.name);
            for (const projected_splat& s : b.project(q)) CHECK_FALSE(s.drawn);
        }
    }
}
