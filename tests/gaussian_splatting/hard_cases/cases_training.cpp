// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <random>

#include "bounds.hpp"
#include "cases.hpp"
#include "healthy.hpp"
#include "model/opacity.hpp"
#include "table.hpp"

using namespace hard_cases;

namespace {

/// A constant image before a constant photo, which a background makes, of any brightness. A power of two
/// goes through the photo's bytes as it is.
compare_case flat_renders(double render, float photo, int size) {
    const auto pixels = static_cast<std::size_t>(size * size);
    compare_case q{size, size, {}, {}, {photo, photo, photo}};
    q.render.assign(3 * pixels, static_cast<float>(render));
    q.rgba.assign(4 * pixels, 0);
    return q;
}

}  // namespace

TEST_CASE("case 20: the variances of the structural similarity of constant images") {
    for (const int size : {1, 12, 33})
        for (const float photo : {0.1f, 0.7f, 1.0f, 100.0f})
            for (const double apart : {0.0, 1e-7, -1e-7, 1e-3, 0.5}) {
                CAPTURE(size);
                CAPTURE(photo);
                CAPTURE(apart);
                // In units of the brightness: 1e-7 of it is an ulp or none.
                const double render = static_cast<double>(photo) * (1 + apart);
                compare_case q = flat_renders(render, photo, size);
                compare_case noisy = q;
                for (std::size_t i = 0; i < q.render.size(); i += 3)
                    noisy.render[i] = std::nextafter(static_cast<float>(q.render[i]), 1e9f);
                for (const compare_case* given : {&q, &noisy}) {
                    const compare_result exact = reference().compare(*given);
                    on_each_backend([&](const backend& b) {
                        const compare_result a = b.compare(*given);
                        CHECK(std::abs(a.quality.ssim) <= 1);
                        CHECK(a.quality.ssim == doctest::Approx(exact.quality.ssim).epsilon(1e-5));
                        CHECK(all_finite(a.gradient));
                        // To a thousandth of L1's gradient, which is 0.8 a value; for images brighter than
                        // photos are, as much less exactly as their differences are rounded.
                        const double each = 0.8 * std::max(1.0, static_cast<double>(photo)) /
                                            static_cast<double>(q.render.size());
                        CHECK(distance(a.gradient, exact.gradient) <= 1e-3 * each);
                        if (given == &q && apart == 0) {
                            CHECK(a.quality.ssim == 1);
                            CHECK(largest(a.gradient) == 0);
                        }
                    });
                }
            }
}

TEST_CASE("case 21: the logit of an opacity of 0 and of 1") {
    const float below = std::nextafter(1.0f, 0.0f), above = std::nextafter(0.0f, 1.0f);
    std::vector<double> logits;
    for (const float p : {0.0f, above, 1e-30f, 0.005f, 0.01f, 0.5f, 0.99f, below, 1.0f}) {
        CAPTURE(p);
        const float logit = gs::logit(p);
        CHECK(std::isfinite(logit));
        const float back = gs::sigmoid(logit);
        CHECK(std::abs(back - p) <= 1e-6f * std::min(p, 1 - p) + 0x1p-24f);
        logits.push_back(static_cast<double>(logit));
    }
    CHECK(gs::logit(0) < -80);
    CHECK(gs::logit(1) > 16);
    // Their renders are finite, too.
    on_each_variant([&](const backend& b, accumulator how) {
        for (const double logit : logits) {
            render_case q = faint_crowd(21, 10);
            q.how = how;
            q.parameters[3][5] = logit;
            CHECK(all_finite(b.render(q)));
        }
    });
}

TEST_CASE("case 22: densification of what was never seen, or seen to move by 1e30") {
    gs::train::densify_config config;
    constexpr std::uint32_t none = 0xffffffffu;
    on_each_backend([&](const backend& b) {
        // Never seen; seen without gradient; a small, a large and a huge gradient; the result of a broken
        // sum.
        const std::vector<sighting> seen{{0, 0}, {0, 7}, {1e-3, 1e3}, {1, 1e3}, {1e30, 1}, {1e38, 100}};
        const judgment j = b.judge(seen, std::vector<double>(seen.size(), 2.0), config);
        CHECK(j.stays == std::vector<std::uint32_t>(seen.size(), 1));
        CHECK(j.urgency[0] == none);
        CHECK(j.urgency[1] == none);
        CHECK(j.urgency[2] == none);
        CHECK(j.urgency[3] < none);
        CHECK(j.urgency[4] < j.urgency[3]);
        CHECK(j.urgency[5] < j.urgency[4]);
        // Nobody grows who was never seen, however low the bar.
        config.gradient = 0;
        CHECK(b.judge({{0, 0}}, {2.0}, config).urgency[0] == none);
        config.gradient = gs::train::densify_config{}.gradient;
    });
    // A gradient of 1e30 by the image, on its way through the backward pass into the statistics.
    on_each_variant([&](const backend& b, accumulator how) {
        render_case q = faint_crowd(22, 10);
        // One, bright, whose gradient is larger than floats are.
        render_case single = empty_case(1, 1);
        gaussian g;
        g.mean = {0.5, 0.25, 4};
        g.color = {20, 20, 20};
        add(single, g);
        single.weights = {3e38};
        single.how = q.how = how;
        const auto check_sound = [](const std::vector<sighting>& sightings) {
            for (const sighting& s : sightings) {
                CHECK(std::isfinite(s.gradient));
                CHECK(s.gradient >= 0);
                CHECK(std::isfinite(s.seen));
            }
        };
        check_sound(b.render(single).sightings);
        // A gradient that is no number is not counted, and neither is the look.
        single.weights = {std::nan("")};
        for (const sighting& s : b.render(single).sightings) {
            CHECK(s.gradient == 0);
            // Fixed point has no NaN: it leaves such sums out and sets a flag.
            CHECK(s.seen == (how == accumulator::fixed ? 1 : 0));
        }
        for (const double size : {1e30, 1e36, infinity}) {
            CAPTURE(size);
            q.weights.assign(q.pixels(), size);
            check_sound(b.render(q).sightings);
        }
    });
}

TEST_CASE("case 23: Adam recovers from any gradient") {
    const std::vector<double> sizes{0, 1e-45, 1e-20, 1e20, infinity, -infinity, std::nan(""), -3e38, 1e18};
    constexpr double rate = 0.01;
    on_each_backend([&](const backend& b) {
        // Ten ordinary steps, one with that gradient, and a hundred ordinary ones.
        std::vector<std::vector<double>> gradients(111, std::vector<double>(sizes.size(), 1.0));
        gradients[10] = sizes;
        const auto path = b.descend(gradients, rate, {}, 0);
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            CAPTURE(sizes[i]);
            for (const auto& values : path) REQUIRE(std::isfinite(values[i]));
            // A step that was left out moves nothing; each of the hundred moves by nearly the rate again.
            if (!(std::abs(sizes[i]) < 1e18)) CHECK(path[10][i] == path[9][i]);
            const double moved = path[10][i] - path[110][i];
            CHECK(moved > 0.7 * 100 * rate);
            CHECK(moved < 1.3 * 100 * rate);
        }
        // Nothing but denormals: no step is larger than the rate.
        for (const double g : {0.0, 1e-45, 1e-40, 1e-20}) {
            const auto still = b.descend({{g}, {g}, {g}}, rate, {}, 0);
            CHECK(std::abs(still.back()[0]) <= 3.1 * rate);
        }
    });
}

TEST_CASE("Adam moves those that take part as a dense one does all, and touches nobody else") {
    constexpr std::size_t steps = 40, count = 75;  // rows of 8, blocks of 32, and the rest of both
    constexpr double rate = 0.01;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> gradients(steps, std::vector<double>(count));
    std::vector<std::vector<std::uint32_t>> takes_part(steps, std::vector<std::uint32_t>(count));
    for (std::size_t s = 0; s < steps; ++s)
        for (std::size_t i = 0; i < count; ++i) {
            // A third always, a third now and then, a third seldom, and a row of eight never.
            const std::size_t one_in = i >= 40 && i < 48 ? 0 : i % 3 == 0 ? 1 : i % 3 == 1 ? 4 : 15;
            takes_part[s][i] = one_in != 0 && random() % one_in == 0 ? 1 : 0;
            gradients[s][i] = static_cast<float>(std::exp(3 * normal(random)) * normal(random));
        }
    // In the first steps the corrections of bias change from step to step, and who was away is moved by those
    // of its return; later all are 1.
    for (const std::uint32_t before : {0u, 30000u}) {
        CAPTURE(before);
        // The paper's algorithm 1, with gradients of zero for those that take no part, once they do again.
        std::vector<std::vector<double>> expected(steps, std::vector<double>(count));
        for (std::size_t i = 0; i < count; ++i) {
            double m = 0, v = 0, x = 0;
            for (std::size_t s = 0, next = 0; s < steps; ++s) {
                if (takes_part[s][i] == 0) continue;
                const auto t = static_cast<double>(before + s + 1);
                for (; next <= s; ++next) {
                    const double g = next == s ? gradients[s][i] : 0;
                    m = 0.9 * m + 0.1 * g;
                    v = 0.999 * v + 0.001 * g * g;
                    x -= rate * (m / (1 - std::pow(0.9, t))) /
                         (std::sqrt(v / (1 - std::pow(0.999, t))) + 1e-15);
                }
                expected[s][i] = x;
            }
        }
        auto given = gradients;
        for (std::size_t s = 0; s < steps; ++s)
            for (std::size_t i = 0; i < count; ++i)
                if (takes_part[s][i] == 0) given[s][i] = std::nan("");  // no camera sees it
        on_each_backend([&](const backend& b) {
            const auto path = b.descend(given, rate, takes_part, before);
            for (std::size_t s = 0; s < steps; ++s)
                for (std::size_t i = 0; i < count; ++i) {
                    CAPTURE(s);
                    CAPTURE(i);
                    if (takes_part[s][i] == 0)
                        CHECK(path[s][i] == (s > 0 ? path[s - 1][i] : 0));
                    else
                        CHECK(std::abs(path[s][i] - expected[s][i]) <=
                              1e-5 * rate * static_cast<double>(s + 1));
                }
        });
    }
}

TEST_CASE("case 24: an opacity of 0.01 at 1.4 standard deviations has no gradient, and that is said") {
    render_case q = empty_case(8, 4);
    q.background = {0.5f, 0.5f, 0.5f};
    // On the axis and as wide as a pixel: 1.4 of it beside the last column's center, on a row's center.
    q.view.camera.cx = 7.5 + 1.4;
    q.view.camera.cy = 2.5;
    gaussian g;
    g.mean = {0, 0, 4};
    g.log_scale = glm::dvec3(std::log(0.5 * std::sqrt(1 - 0.3)));
    g.opacity = logit_of(0.01);
    add(q, g);
    // And a point between four pixels, where it is the filter's deviation, 0.55, that counts: 1.29 of it.
    g.mean = {-2.45, -0.25, 4};
    g.log_scale = glm::dvec3(-20);
    g.opacity = logit_of(0.0085);
    add(q, g);
    render_case visible = q;
    visible.parameters[3] = {logit_of(0.02), logit_of(0.02)};
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = visible.how = how;
        const render_result a = b.render(q);
        for (const auto& gradients : a.gradients) CHECK(largest(gradients) == 0);
        // Their tile is theirs to draw in all the same, and that they took no gradient is reported.
        for (const projected_splat& s : b.project(q)) CHECK(s.drawn);
        CHECK(b.judge(a.sightings, q.parameters[3], {}).without_gradient == 2);
        const render_result seen = b.render(visible);
        for (const double by_opacity : seen.gradients[3]) CHECK(by_opacity != 0);
        CHECK(b.judge(seen.sightings, visible.parameters[3], {}).without_gradient == 0);
    });
}
