// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "engines.hpp"
#include "model/spherical_harmonics.hpp"
#include "optimize/moment_arrays.hpp"
#include "optimize/parameter_storage.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using pair = gs::train::moment_pair<float, std::uint32_t>;
using colors = gs::train::color_moments<float, std::uint32_t>;

struct spread {
    double mean, deviation;
};

/// The mean and the standard deviation of `value` over random words.
template <class F>
spread over_random_words(const F& value) {
    constexpr int n = 20000;
    std::mt19937 random(1);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const double x = value(static_cast<std::uint32_t>(random()));
        sum += x;
        squares += x * x;
    }
    return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / n / n))};
}

gs::train::train_options short_run(gs::train::moment_precision precision) {
    gs::train::train_options o;
    o.schedule.iterations = 400;
    o.schedule.sh_degree_interval = 50;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 60;
    adaptive.densification_interval = 40;
    adaptive.densify_until_iter = 250;
    adaptive.opacity_reset_interval = 120;
    o.max_cap = 3000;
    o.gradient = gs::accumulator::fixed;
    o.storage.precision = precision;
    return o;
}

}  // namespace

TEST_CASE("compact moments: zero and upper halves of floats are exact, other values are so in the mean") {
    CHECK(pair{0, 0}.pack(0xffffffffu) == 0);
    for (const float exact : {1.0f, -0.75f, 0x1.02p-40f}) {
        const pair back = pair::unpack(pair{exact, std::abs(exact)}.pack(0xffffffffu));
        CHECK(back.first == exact);
        CHECK(back.second == std::abs(exact));
    }
    for (const double x : {1.003, -0.33333, 3e-17, -2.9e-21, 1e30}) {
        CAPTURE(x);
        const auto m = over_random_words([&](std::uint32_t random) {
            return static_cast<double>(pair::unpack(pair{static_cast<float>(x), 1}.pack(random)).first);
        });
        const auto v = over_random_words([&](std::uint32_t random) {
            return static_cast<double>(
                pair::unpack(pair{1, static_cast<float>(std::abs(x))}.pack(random)).second);
        });
        CHECK(m.mean == doctest::Approx(x).epsilon(1e-4));
        CHECK(v.mean == doctest::Approx(std::abs(x)).epsilon(1e-4));
        CHECK(m.deviation < std::abs(x) / 128);
    }
}

TEST_CASE("compact moments: those of colors are exact in the mean, and stay in their range") {
    CHECK(colors{{0, 0, 0}}.pack(0xffffffffu) == 0);
    CHECK(colors::unpack(0).relative[1] == 0);
    for (const double x : {0.0, 0.01, -0.2345, 5.5, -12.6})
        for (int n = 0; n < 3; ++n) {
            CAPTURE(x);
            const auto found = over_random_words([&](std::uint32_t random) {
                colors m{{1, -2, 3}};
                m.relative[n] = static_cast<float>(x);
                return static_cast<double>(colors::unpack(m.pack(random)).relative[n]);
            });
            CHECK(std::abs(found.mean - x) < 5e-4);
            CHECK(found.deviation < 0.013);
        }
    constexpr float infinity = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    const auto back = colors::unpack(colors{{infinity, -infinity, nan}}.pack(0x12345678u));
    CHECK(back.relative[0] == doctest::Approx(12.75));
    CHECK(back.relative[1] == doctest::Approx(-12.775).epsilon(1e-3));
    CHECK(std::isfinite(back.relative[2]));
}

TEST_CASE("compact moments: the mean square of the SH basis is the same for all degrees and directions") {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        double basis[16]{};
        gs::sh_basis(3, direction, basis);
        for (int degree = 0, k = 0; degree < 4; ++degree) {
            double squares = 0;
            for (int m = 0; m < 2 * degree + 1; ++m, ++k) squares += basis[k] * basis[k];
            CHECK(squares / (2 * degree + 1) == doctest::Approx(basis[0] * basis[0]));
        }
    }
}

TEST_CASE("compact moments: a Gaussian takes half the memory") {
    using enum gs::train::moment_precision;
    CHECK(gs::train::bytes_per_gaussian(3, {full}).on_device == 708);
    CHECK(gs::train::bytes_per_gaussian(3, {compact}).on_device == 348);
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto engine = make();
        engine->set_views(scene.train, scene.test, 0);
        engine->set_model(gs::from_points(scene.points, 3, 300, 1));
        std::array<std::uint64_t, 2> expected{};
        for (const auto how : {full, compact}) {
            auto setup = setup_with(gs::accumulator::native);
            setup.storage.precision = how;
            engine->begin(setup);
            expected[static_cast<std::size_t>(how)] = engine->profile().forecast(1000000, 3).gaussians;
        }
        CHECK(expected[1] + 360000000 == expected[0]);
    }
}

TEST_CASE("compact moments: training comes as close to the photos, with SH degrees, growth and resets") {
    const gs::scene scene = small_scene("synthetic:spheres,gloss=0.6");
    using enum gs::train::moment_precision;
    for (const auto make : engines()) {
        std::array<double, 2> psnr{};
        std::array<std::size_t, 2> count{};
        std::array<gs::gaussians, 2> models;
        for (const auto how : {full, compact}) {
            const auto i = static_cast<std::size_t>(how);
            const auto engine = make();
            engine->set_views(scene.train, scene.test, 1);
            engine->set_model(gs::from_points(scene.points, 3, 600, 1));
            const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
            gs::train::train(*engine, scene, short_run(how), quiet);
            for (std::size_t v = 0; v < scene.test.size(); ++v)
                psnr[i] += engine->measure(v, {}).psnr() / static_cast<double>(scene.test.size());
            count[i] = engine->count();
            models[i] = engine->get_model();
        }
        CHECK(psnr[0] > 20);
        CHECK(psnr[1] > psnr[0] - 0.3);
        CHECK(count[1] > 600);
        CHECK(models[0].mean != models[1].mean);
        CHECK(std::ranges::any_of(models[1].sh_rest, [](float x) { return x != 0; }));
    }
}
