// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "bounds.hpp"
#include "lists.hpp"
#include "table.hpp"

using namespace hard_cases;

TEST_CASE("case 6: both passes stop at the same splat, by hand") {
    // T is 0.05, 0.0025, 0.000125; the fourth would bring it below 0.0001 and is left out.
    blend_case q = empty_list(8, 4);
    for (int i = 0; i < 8; ++i) {
        q.splats.push_back(round_splat(3.5, 2.5, 0, 0.95));
        q.splats.back().color = {1, 0.5, 0.25};
    }
    constexpr std::size_t pixel = 2 * 8 + 3;
    q.gradient.assign(3 * 32, 0.0);
    q.gradient[pixel] = 1;
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = how;
        const blend_result a = b.blend(q);
        CHECK(a.last[pixel] == 3);
        CHECK(a.transmittance[pixel] == doctest::Approx(1.25e-4).epsilon(1e-5));
        CHECK(a.render[pixel] == doctest::Approx(1 - 1.25e-4).epsilon(1e-6));
        CHECK(a.sums[0][0] == doctest::Approx(0.95).epsilon(1e-5));
        CHECK(a.sums[1][0] == doctest::Approx(0.0475).epsilon(1e-5));
        CHECK(a.sums[2][0] == doctest::Approx(0.002375).epsilon(1e-5));
        for (std::size_t i = 3; i < 8; ++i)
            for (const double sum : a.sums[i]) CHECK(sum == 0);
    });
}

TEST_CASE("case 7: splats that a pixel does not see are not counted") {
    // The faint ones are seen at their center, a pixel away, but not at ours.
    const flat_splat faint = round_splat(5.5, 2.5, 0, 1.2 / 255);
    flat_splat strong = round_splat(3.5, 2.5, 0, 0.5);
    strong.color = {1, 1, 1};
    blend_case q = empty_list(8, 4);
    q.splats = {faint, strong, faint, strong, faint, faint, faint};
    constexpr std::size_t pixel = 2 * 8 + 3;
    q.gradient.assign(3 * 32, 0.0);
    q.gradient[pixel] = 1;
    on_each_variant([&](const backend& b, accumulator how) {
        q.how = how;
        const blend_result a = b.blend(q);
        CHECK(a.last[pixel] == 4);
        CHECK(a.last[pixel + 2] == 7);  // where the faint ones are
        CHECK(a.transmittance[pixel] == 0.25);
        CHECK(a.sums[1][0] == 0.5);  // 0.5 times a T of exactly 1
        CHECK(a.sums[3][0] == 0.25);
        for (const std::size_t i : {0, 2, 4, 5, 6})
            for (const double sum : a.sums[i]) CHECK(sum == 0);
    });
}

TEST_CASE("case 26: a list of 100,000 splats of alpha 1/255") {
    std::mt19937 random(26);
    std::uniform_real_distribution<double> uniform;
    // All on one pixel, where T ends after some 2,300; and 20,000 over the pixels of a patch, 600 each.
    blend_case deep = empty_list(8, 4), wide = empty_list(8, 4);
    constexpr std::size_t pixel = 1 * 8 + 5;
    for (int i = 0; i < 100000; ++i) {
        deep.splats.push_back(round_splat(5.5, 1.5, 0, (1 + 0.01 * uniform(random)) / 255));
        if (i < 20000)
            wide.splats.push_back(round_splat(static_cast<double>(random() % 8) + 0.5,
                                              static_cast<double>(random() % 4) + 0.5, 0,
                                              (1 + 0.01 * uniform(random)) / 255));
    }
    deep.splats[0].color = {1, 1, 1};
    for (flat_splat& s : wide.splats) s.color = {1, 1, 1};
    deep.gradient.assign(3 * 32, 0.0);
    deep.gradient[pixel] = 1;
    wide.gradient.assign(3 * 32, 1.0);
    const blend_result expected_wide = reference().blend(wide);
    on_each_variant([&](const backend& b, accumulator how) {
        deep.how = wide.how = how;
        const blend_result a = b.blend(deep);
        CHECK(a.last[pixel] > 2300);
        CHECK(a.last[pixel] < 2400);
        blend_case as_far = deep;
        as_far.splats.resize(a.last[pixel]);
        as_far.gradient.clear();
        CHECK(a.transmittance[pixel] ==
              doctest::Approx(reference().blend(as_far).transmittance[pixel]).epsilon(1e-4));
        CHECK(recovered(a, 0, 0, a.render[pixel]) == doctest::Approx(1).epsilon(1e-4));

        const blend_result w = b.blend(wide);
        double worst = 0;
        for (std::size_t i = 0; i < 32; ++i)
            worst = std::max(worst, std::abs(w.transmittance[i] / expected_wide.transmittance[i] - 1));
        CHECK(worst <= 1e-4);
        std::vector<double> got, wanted;
        for (std::size_t i = 0; i < wide.splats.size(); ++i) {
            got.push_back(w.sums[i][0]);
            wanted.push_back(expected_wide.sums[i][0]);
        }
        CHECK(excess(got, wanted) == "");
    });
}

TEST_CASE("case 27: what cancels in the sums of gradients") {
    // Pairs of a million each that leave 1e-3, in 20 orders. u is half an ulp of 1.
    constexpr double u = 0x1p-24;
    const double left = static_cast<double>(1e-3f);
    on_each_variant([&](const backend& b, accumulator how) {
        // Each value by itself, or a warp's first.
        const double lanes = how == gs::lab::per_lane ? 1 : b.lanes;
        const auto rounds = [&](double n) { return n / lanes + std::log2(lanes); };
        for (const std::size_t n : {64, 1024}) {
            CAPTURE(n);
            std::vector<double> values{left};
            for (std::size_t i = 0; i + 1 < n / 2; ++i) {
                values.push_back(1e6);
                values.push_back(-1e6);
            }
            const double mass = static_cast<double>(values.size()) * 1e6;
            const double bound = rounds(static_cast<double>(n)) * u * mass;
            double worst = 0;
            for (unsigned seed = 0; seed < 20; ++seed) {
                std::mt19937 random(seed);
                std::shuffle(values.begin(), values.end(), random);
                worst = std::max(worst, std::abs(b.sum(values, how) - left));
            }
            CHECK(worst <= bound);
        }
        // If each partial sum is a float, the result is exact in any order.
        std::vector<double> exact{0x1p-3};
        for (int i = 0; i < 511; ++i) {
            exact.push_back(0x1p10);
            exact.push_back(-0x1p10);
        }
        std::mt19937 order(7);
        std::shuffle(exact.begin(), exact.end(), order);
        CHECK(b.sum(exact, how) == 0x1p-3);

        // The same through the backward pass: under a capped alpha each pixel adds 0.99 times its gradient.
        blend_case q = empty_list(16, 16);
        q.how = how;
        q.splats = {round_splat(8, 8, 3000, 1)};
        std::vector<double> pixels{0x1p-10, 0};
        for (int i = 0; i < 127; ++i) {
            pixels.push_back(0x1p20);
            pixels.push_back(-0x1p20);
        }
        std::mt19937 random(27);
        for (int channel = 0; channel < 3; ++channel) {
            std::shuffle(pixels.begin(), pixels.end(), random);
            q.gradient.insert(q.gradient.end(), pixels.begin(), pixels.end());
        }
        const auto sums = b.blend(q).sums[0];
        const double mass = 254 * 0x1p20 * 0.99;
        for (std::size_t channel = 0; channel < 3; ++channel)
            CHECK(std::abs(sums[channel] - 0.99 * 0x1p-10) <= rounds(256) * u * mass);
    });
}
