// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cfloat>
#include <cmath>

#include "bounds.hpp"
#include "cases.hpp"
#include "checks.hpp"
#include "healthy.hpp"
#include "render/project/geometry.hpp"
#include "table.hpp"

using namespace hard_cases;

TEST_CASE("case 15: nothing to draw") {
    for (const auto& [width, height] : {std::pair{1, 1}, {16, 16}, {20, 10}, {50, 40}}) {
        const render_case crowded = random_case(9, 3, width, height, 1);
        std::vector<render_case> empty(4, crowded);
        for (auto& p : empty[0].parameters) p.clear();
        empty[1].view.camera.translation = glm::dvec3(0, 0, -9);                  // behind the camera
        empty[2].parameters[3].assign(3, -20.0);                                  // transparent
        for (std::size_t i = 0; i < 3; ++i) empty[3].parameters[0][3 * i] = 1e4;  // beside the image
        for (render_case& q : empty) {
            CAPTURE(width);
            CAPTURE(&q - empty.data());
            on_each_variant([&](const backend& b, accumulator how) {
                q.how = how;
                const render_result a = b.render(q);
                REQUIRE(a.render.size() == 3 * q.pixels());
                std::size_t other = 0;
                for (std::size_t i = 0; i < a.render.size(); ++i)
                    other += a.render[i] == static_cast<double>(q.background[i / q.pixels()]) ? 0 : 1;
                CHECK(other == 0);
                CHECK(all_finite(a));
                for (const auto& gradients : a.gradients) CHECK(largest(gradients) == 0);
            });
        }
    }
}

TEST_CASE("case 16: opacities at the least that is drawn") {
    // In the middle of a pixel, where alpha is the opacity.
    render_case q = faint_crowd(16, crowd);
    q.view.camera = empty_case(8, 4).view.camera;
    double* mean = values_of(q, gs::parameter::mean, victim);
    mean[0] = mean[1] = 0.25;
    mean[2] = 4;
    const auto least = static_cast<float>(-std::log(254.0));
    std::vector<double> logits{-5.6, -6, -20, -89, -104, -static_cast<double>(FLT_MAX)};
    float above = least, below = least;
    for (int ulps = 0; ulps <= 8; ++ulps) {
        logits.push_back(above);
        logits.push_back(below);
        above = std::nextafter(above, 0.0f);
        below = std::nextafter(below, -10.0f);
    }
    logits.push_back(-5.5);
    on_each_variant([&](const backend& b, accumulator how) {
        render_case rest = without(q, victim);
        q.how = rest.how = how;
        const render_result alone = b.render(rest);
        bool was_drawn = false;
        for (const double logit : logits) {
            CAPTURE(logit);
            values_of(q, gs::parameter::opacity, victim)[0] = logit;
            const render_result a = b.render(q);
            const bool drawn = b.project(q)[victim].drawn;
            was_drawn = drawn;
            CHECK(all_finite(a));
            if (std::abs(logit - static_cast<double>(least)) > 1e-5) CHECK(drawn == (logit > least));
            if (!drawn) CHECK(harm(a, alone, victim, is_loose(b, how)) == "");
            // Its alpha is 1/255 at most here, its share of the image no more than that.
            CHECK(distance(a.render, alone.render) < 2.0 / 255);
        }
        CHECK(was_drawn);
    });
}

TEST_CASE("case 17: depths of zero and of either sign, and at the near plane") {
    constexpr auto near = static_cast<float>(gs::raster::near_plane);
    const auto at_depth = [](render_case& q, double z, double opacity, double red) {
        gaussian g;
        g.mean = {0, 0, z};
        g.log_scale = glm::dvec3(std::max(std::log(std::abs(z) * 100 + 1e-20), -20.0));
        g.opacity = opacity;
        g.color = {red, 1 - red, 0.5};
        add(q, g);
    };
    SUBCASE("not in front of it: culled") {
        for (const double z : {-0.0, 0.0, 1e-30, -1e-30, -0.2, -4.0, static_cast<double>(near),
                               static_cast<double>(std::nextafter(near, 0.0f))}) {
            CAPTURE(z);
            render_case q = faint_crowd(17, crowd);
            q.view.camera.rotation = glm::dmat3(1);
            q.view.camera.translation = glm::dvec3(0);
            for (std::size_t i = 0; i < crowd; ++i) values_of(q, gs::parameter::mean, i)[2] += 4;
            double* mean = values_of(q, gs::parameter::mean, victim);
            mean[0] = mean[1] = 0;
            mean[2] = z;
            check_culled(q);
        }
    }
    SUBCASE("in front of it: in the order of their depth") {
        // An ulp apart, and very far apart; put down in no order.
        std::vector<double> depths;
        float z = near;
        for (int i = 0; i < 8; ++i) depths.push_back(z = std::nextafter(z, 1.0f));
        for (const double far : {0.3, 1.0, 1e3, 1e8}) depths.push_back(far);
        render_case q = empty_case(8, 4);
        paint_photo(q, 17);
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const std::size_t rank = i * 5 % depths.size();
            at_depth(q, depths[rank], 0, static_cast<double>(rank) / 12);
        }
        double T = 1, red = 0;
        for (std::size_t rank = 0; rank < depths.size(); ++rank) {
            red += 0.5 * T * static_cast<double>(rank) / 12;
            T *= 0.5;
        }
        on_each_variant([&](const backend& b, accumulator how) {
            q.how = how;
            const render_result a = b.render(q);
            for (std::size_t i = 0; i < q.pixels(); ++i)
                CHECK(a.render[i] == doctest::Approx(red).epsilon(1e-3));
            CHECK(all_finite(a));
        });
    }
}

TEST_CASE("case 25: images of odd sizes") {
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 17}, {17, 1}, {15, 15}, {16, 16}, {17, 17}, {33, 47}, {257, 257}}) {
        CAPTURE(width);
        CAPTURE(height);
        render_case q = random_case(25, 20, width, height, 2);
        // The width is the same for thin images and for others.
        q.view.camera.fx = q.view.camera.fy = std::max(width, height);
        check_drawn(q, true);
    }
}
