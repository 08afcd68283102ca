// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "differences.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <sstream>

#include "bounds.hpp"
#include "budget.hpp"
#include "cases.hpp"
#include "table.hpp"

namespace hard_cases {

void verdict::operator+=(const verdict& other) {
    right += other.right;
    wrong += other.wrong;
    straddling += other.straddling;
    if (first_wrong.empty()) first_wrong = other.first_wrong;
}

namespace {

/// The derivative of `loss` at 0.
double difference(const std::function<double(double)>& loss, double step) {
    return (loss(step) - loss(-step)) / (2 * step);
}

verdict judge(double gradient, const std::function<double(double)>& loss, double most,
              const std::string& what) {
    verdict v;
    const double expected = difference(loss, 1e-6);
    const auto close = [&](double a, double b) {
        return std::abs(a - b) <= 1e-5 * std::max(std::abs(a), std::abs(b)) + 1e-7 * most + 5e-10;
    };
    if (close(gradient, expected)) {
        v.right = 1;
    } else if (!close(difference(loss, 4e-7), expected)) {
        v.straddling = 1;
    } else {
        v.wrong = 1;
        std::ostringstream said;
        said << what << ": " << gradient << " instead of " << expected;
        v.first_wrong = said.str();
    }
    return v;
}

}  // namespace

verdict check_by_differences(const render_case& given, const std::vector<std::size_t>& gaussians,
                             unsigned seed) {
    render_case q = given;
    const render_result a = reference().render(q);
    verdict all;
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        if (q.parameters[p].empty()) continue;
        const auto width = static_cast<std::size_t>(gs::parameter_width[p]);
        for (const std::size_t g : gaussians)
            for (std::size_t i = g * width; i < (g + 1) * width; ++i) {
                double& x = q.parameters[p][i];
                const double at = x;
                all += judge(
                    a.gradients[p][i],
                    [&](double step) {
                        x = at + step;
                        const double loss = reference().loss(q);
                        x = at;
                        return loss;
                    },
                    largest(a.gradients[p]), parameter_names[p] + " " + std::to_string(i));
            }
    }

    // Steps are chosen so that all parameters change the loss by similar amounts.
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::array<std::vector<double>, gs::parameter_count> direction;
    double along = 0, most = 0;
    for (std::size_t p = 0; p < gs::parameter_count; ++p)
        for (const double g : a.gradients[p]) {
            const double d = normal(random);
            direction[p].push_back(d);
            along += d * g;
            most = std::max(most, std::abs(g));
        }
    all += judge(
        along,
        [&](double step) {
            render_case moved = q;
            for (std::size_t p = 0; p < gs::parameter_count; ++p)
                for (std::size_t i = 0; i < direction[p].size(); ++i)
                    moved.parameters[p][i] += step * direction[p][i];
            return reference().loss(moved);
        },
        most, "all parameters together");
    return all;
}

}  // namespace hard_cases

using namespace hard_cases;

TEST_CASE("the reference's gradients are those of central differences") {
    // 100 scenes of 1 to 49 splats, of 8 x 8 to 33 x 47 pixels, every degree; two Gaussians of each.
    constexpr int seeds = 100;
    verdict all;
#pragma omp parallel for schedule(dynamic, 1) num_threads(omp_get_num_procs())
    for (int seed = 0; seed < seeds; ++seed) {
        std::mt19937 random(static_cast<unsigned>(seed));
        const auto up_to = [&](unsigned from, unsigned to) { return from + random() % (to - from + 1); };
        const auto splats = seed == 0 ? 49 : up_to(1, 49);
        const auto width = static_cast<int>(seed == 0 ? 33 : up_to(8, 33) / (1 + seed % 2));
        const auto height = static_cast<int>(seed == 0 ? 47 : up_to(8, 47) / (1 + seed % 2));
        render_case q = random_case(static_cast<unsigned>(seed), splats, std::max(8, width),
                                    std::max(8, height), seed % 4);
        q.effects.antialiasing = seed / 4 % 2 == 1;
        if (seed / 8 % 2 == 1) add_background_image(q, static_cast<unsigned>(seed));
        take_some_lens(q, static_cast<unsigned>(seed));
        if (seed / 32 % 2 == 1) add_depths(q, static_cast<unsigned>(seed));
        if (seed % 10 == 3)  // capped alphas, and pixels that end early
            for (double& o : q.parameters[3]) o += 6;
        std::vector<std::size_t> some(splats);
        std::iota(some.begin(), some.end(), 0);
        std::shuffle(some.begin(), some.end(), random);
        some.resize(std::min<std::size_t>(splats, brief ? 1 : 2));
        const verdict v = check_by_differences(q, some, static_cast<unsigned>(seed));
#pragma omp critical
        all += v;
    }
    CAPTURE(all.right);
    CAPTURE(all.straddling);
    CHECK_MESSAGE(all.wrong == 0, all.first_wrong);
    CHECK(all.right > (brief ? 2500 : 5000));
    CHECK(static_cast<double>(all.straddling) < 0.02 * static_cast<double>(all.right + all.straddling));
    MESSAGE(all.right << " agree, " << all.straddling << " straddle a threshold");
}

TEST_CASE("the loss's gradient by the image is that of central differences") {
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{8, 8}, {1, 1}, {13, 4}}) {
        compare_case q{width, height, {}, {}, {0.3f, 0.1f, 0.9f}};
        const auto pixels = static_cast<std::size_t>(width * height);
        for (std::size_t i = 0; i < 4 * pixels; ++i)
            q.rgba.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 200 : random() % 201));
        for (std::size_t i = 0; i < 3 * pixels; ++i)
            q.render.push_back(static_cast<double>(random() % 1000) / 999);
        const compare_result a = reference().compare(q);
        verdict all;
        for (std::size_t i = 0; i < q.render.size(); ++i) {
            const double at = q.render[i];
            all += judge(
                a.gradient[i],
                [&](double step) {
                    q.render[i] = at + step;
                    const double loss = reference().compare(q).loss;
                    q.render[i] = at;
                    return loss;
                },
                largest(a.gradient), "value " + std::to_string(i));
        }
        CHECK_MESSAGE(all.wrong == 0, all.first_wrong);
        CHECK(all.straddling == 0);
    }
}
