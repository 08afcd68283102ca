// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numeric>

#include "bounds.hpp"
#include "cases.hpp"
#include "lists.hpp"
#include "table.hpp"

using namespace hard_cases;

namespace {

/// Pixel by pixel in the channels of a tile: `use(tile, channel, pixel)` for each that the gradient looks at.
template <class F>
void for_each_look(const blend_case& q, const F& use) {
    const auto pixels = static_cast<std::size_t>(q.width * q.height);
    const auto across = static_cast<std::size_t>((q.width + 15) / 16);
    for (std::size_t i = 0; i < q.gradient.size(); ++i) {
        if (q.gradient[i] == 0) continue;
        const std::size_t pixel = i % pixels, x = pixel % static_cast<std::size_t>(q.width),
                          y = pixel / static_cast<std::size_t>(q.width);
        use(y / 16 * across + x / 16, i / pixels, pixel);
    }
}

}  // namespace

TEST_CASE("case 1: forward and backward see the same alpha, to the bit") {
    constexpr int side = 256, tiles = side / 16 * side / 16;
    constexpr auto pixels = std::size_t{side} * side;
    // A splat a tile: its alpha is the image, and times the recovered T of exactly 1 the red, green and
    // blue sums.
    std::vector<blend_case> single, lists;
    for (unsigned seed = 0; seed < 4; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform;
        blend_case q = empty_list(side, side);
        for (std::uint32_t t = 0; t < tiles; ++t) {
            flat_splat s = random_splat(random, 16, 16, 0.01 + 0.99 * uniform(random));
            s.x += t % (side / 16) * 16;
            s.y += t / (side / 16) * 16;
            s.color = {1, 1, 1};
            q.splats.push_back(s);
            q.lists.push_back({t});
        }
        q.gradient = one_pixel_a_tile(random, side, side);
        single.push_back(q);
    }
    // Lists of up to 300, wide enough for every pixel of their tile, of which the first has a color.
    for (unsigned seed = 10; seed < 12; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform;
        blend_case q = empty_list(64, 64);
        for (std::size_t t = 0; t < 16; ++t) {
            q.lists.emplace_back();
            const double opaque = std::exp(-4 * uniform(random));
            for (double T = 1; q.lists[t].size() < 300;) {
                const double opacity = 0.005 + opaque * uniform(random) * 0.99;
                T *= 1 - opacity;
                if (T < 1.1e-4) break;
                flat_splat s = round_splat(64 * uniform(random), 64 * uniform(random),
                                           300 + 1000 * uniform(random), opacity);
                if (q.lists[t].empty()) s.color = {1, 1, 1};
                q.lists[t].push_back(static_cast<std::uint32_t>(q.splats.size()));
                q.splats.push_back(s);
            }
        }
        q.gradient = one_pixel_a_tile(random, 64, 64);
        lists.push_back(q);
    }

    on_each_variant([&](const backend& b, accumulator how) {
        std::size_t seen = 0, other = 0;
        for (blend_case q : single) {
            q.how = how;
            const blend_result a = b.blend(q);
            for_each_look(q, [&](std::size_t tile, std::size_t channel, std::size_t pixel) {
                const double alpha = a.render[channel * pixels + pixel];
                seen += alpha > 0 ? 1 : 0;
                other += a.sums[tile][channel] == alpha ? 0 : 1;
            });
        }
        CHECK(seen > 1000);
        CHECK(other == 0);

        double least = 2, most = 0;
        for (blend_case q : lists) {
            q.how = how;
            const blend_result a = b.blend(q);
            for_each_look(q, [&](std::size_t tile, std::size_t channel, std::size_t pixel) {
                const double T = recovered(a, q.lists[tile][0], channel, a.render[channel * 64 * 64 + pixel]);
                least = std::min(least, T);
                most = std::max(most, T);
            });
        }
        CHECK(most <= 1 + 1e-5);
        CHECK(least >= 1 - 1e-5);
    });
}

TEST_CASE("case 2: the cap of alpha is the same in both passes") {
    // One of them is capped at 0.99: in front, behind, and between others.
    for (const auto& opacities :
         {std::vector{0.3, 0.9999}, {0.9999, 0.5}, {0.2, 0.9999, 0.7, 0.1}, {0.9999}}) {
        CAPTURE(opacities.size());
        std::mt19937 random(2);
        blend_case q = empty_list(16, 16);
        for (const double o : opacities) q.splats.push_back(round_splat(8, 8, 3000, o));
        q.splats[0].color = {1, 1, 1};
        q.gradient = one_pixel_a_tile(random, 16, 16);
        const blend_result expected = reference().blend(q);
        on_each_variant([&](const backend& b, accumulator how) {
            q.how = how;
            const blend_result a = b.blend(q);
            for_each_look(q, [&](std::size_t, std::size_t channel, std::size_t pixel) {
                CHECK(std::abs(recovered(a, 0, channel, a.render[channel * 256 + pixel]) - 1) <= 1e-4);
                CHECK(a.transmittance[pixel] == doctest::Approx(expected.transmittance[pixel]).epsilon(1e-5));
            });
        });
    }
}

TEST_CASE("case 3: no gradient flows through a capped alpha, but to its color") {
    // In the middle of a list, each of whose others is free.
    blend_case q = empty_list(16, 16);
    for (const double o : {0.3, 1.0, 0.5, 0.2}) {
        q.splats.push_back(round_splat(8, 8, 3000, o));
        q.splats.back().color = {0.1 * static_cast<double>(q.splats.size()), 0.5, 0.9};
    }
    std::mt19937 random(3);
    for (int i = 0; i < 3 * 256; ++i) q.gradient.push_back(static_cast<double>(random() % 100) / 100);
    // All of one Gaussian is capped, its degree is 0: nothing but its color moves the image.
    render_case whole = random_case(3, 0, 8, 4, 0);
    gaussian g;
    g.log_scale = {6, 6.5, 7};
    g.quaternion = {0.9, 0.3, -0.2, 0.1};
    g.opacity = 20;
    whole.view.camera.rotation = glm::dmat3(1);
    whole.view.camera.translation = glm::dvec3(0);
    add(whole, g);
    const blend_result expected = reference().blend(q);
    const render_result expected_whole = reference().render(whole);
    REQUIRE(largest(expected_whole.gradients[4]) > 0.01);

    on_each_variant([&](const backend& b, accumulator how) {
        q.how = whole.how = how;
        const blend_result a = b.blend(q);
        for (std::size_t k = 0; k < 9; ++k) {
            CAPTURE(k);
            for (std::size_t i = 0; i < q.splats.size(); ++i) {
                if (k < 3) CHECK(a.sums[i][k] == doctest::Approx(expected.sums[i][k]).epsilon(1e-5));
                if (i != 1 && k == 3) CHECK(a.sums[i][k] != 0);
            }
            if (k >= 3) CHECK(a.sums[1][k] == 0);
        }
        const render_result by_parameter = b.render(whole);
        for (std::size_t p = 0; p < 4; ++p) {
            CAPTURE(parameter_names[p]);
            CHECK(largest(by_parameter.gradients[p]) == 0);
        }
        CHECK(excess(by_parameter.gradients[4], expected_whole.gradients[4]) == "");
    });
}

TEST_CASE("case 4: alpha near 1") {
    for (const std::size_t splats : {1, 2, 4, 8, 16}) {
        CAPTURE(splats);
        render_case q = random_case(40 + static_cast<unsigned>(splats), splats, 24, 20, 1);
        for (double& o : q.parameters[3]) o = 20;
        q.weights = off_thresholds(q, 1e-4);
        const render_result expected = reference().render(q);
        on_each_variant([&](const backend& b, accumulator how) {
            q.how = how;
            const render_result a = b.render(q);
            CHECK(all_finite(a));
            CHECK(distance(a, expected, q) <= 1e-3);
            CHECK(excess(a, expected) == "");
        });
    }
}

TEST_CASE("case 5: the transmittance of saturated pixels before a background of 1000") {
    blend_case q = empty_list(64, 64);
    q.background = {1000, 1000, 1000};
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    for (std::size_t t = 0; t < 16; ++t) {
        q.lists.emplace_back();
        const double most = 0.05 + 0.85 * uniform(random), end = 1.2e-4 + 7e-4 * uniform(random);
        const auto append = [&](double opacity) {
            flat_splat s = round_splat(64 * uniform(random), 64 * uniform(random), 3000, opacity);
            s.color = {uniform(random), uniform(random), uniform(random)};
            q.lists[t].push_back(static_cast<std::uint32_t>(q.splats.size()));
            q.splats.push_back(s);
        };
        double T = 1;
        while (T * (1 - most) > end * 1.01) {
            const double opacity = most * (0.1 + 0.9 * uniform(random));
            append(opacity);
            T *= 1 - opacity;
        }
        append(1 - end / T);
    }
    for (std::size_t i = 0; i < 3 * 64 * 64; ++i) q.gradient.push_back(0.5 + 0.5 * uniform(random));
    const blend_result expected = reference().blend(q);
    for (const double T : expected.transmittance) REQUIRE((T > 1e-4 && T < 1e-3));

    const auto check_close = [](const std::vector<double>& got, const std::vector<double>& wanted) {
        double worst = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            worst = std::max(worst, std::abs(got[i] / wanted[i] - 1));
        CHECK(worst <= 1e-5);
    };
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = how;
        const blend_result a = b.blend(q);
        check_close(a.transmittance, expected.transmittance);
        check_close(a.render, expected.render);
        std::vector<double> sums, wanted;
        for (std::size_t i = 0; i < q.splats.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                sums.push_back(a.sums[i][k]);
                wanted.push_back(expected.sums[i][k]);
            }
        // The background behind is most of dL/dalpha, so that nothing cancels in it.
        check_close(sums, wanted);
    });
}
