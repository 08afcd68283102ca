// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cfloat>
#include <cmath>
#include <limits>

#include "bounds.hpp"
#include "budget.hpp"
#include "cases.hpp"
#include "healthy.hpp"
#include "table.hpp"

using namespace hard_cases;

namespace {

constexpr double most = FLT_MAX, least = FLT_MIN, denormal = 0x1p-149;

constexpr double injected_values[] = {
    not_a_number, infinity, -infinity, 0.0,   -0.0,  denormal, -denormal, least, -least, most, -most,
    1e30,         -1e30,    1e20,      -1e20, 1e-30, 1e-20,    -1e-20,    40,    -40,    120,  -120};
static_assert(std::size(injected_values) == 22);

constexpr std::size_t crowd_size = brief ? 40 : 120, injected_index = crowd_size / 2;

/// Whether a Gaussian is none, from the definition: it has parameters that are not finite, no extent that a
/// float could hold, or no orientation.
bool is_bad(const render_case& q, std::size_t i) {
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        const auto width = static_cast<std::size_t>(gs::parameter_width[p]);
        for (std::size_t k = i * width; k < (i + 1) * width; ++k)
            if (!std::isfinite(q.parameters[p][k])) return true;
    }
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
        if (!(std::exp(q.parameters[1][k]) <= most)) return true;
    double length = 0;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) length = std::max(length, std::abs(q.parameters[2][k]));
    return length < least;
}

/// One value in one parameter of the victim, and the result of the reference.
struct injected {
    std::size_t parameter, element;
    double value;
    bool is_bad = false, is_drawn = false;
    std::vector<double> weights{}, render{};  ///< where it is drawn
};

/// To a thousandth of the brightest, off the thresholds.
bool alike(const std::vector<double>& render, const injected& one) {
    double apart = 0;
    for (std::size_t i = 0; i < render.size(); ++i)
        if (one.weights[i % one.weights.size()] != 0)
            apart = std::max(apart, std::abs(render[i] - one.render[i]));
    return apart <= 1e-3 * std::max(1.0, largest(one.render));
}

/// A crowd, and each value in each of the first parameters of the victim, as the reference sees them.
struct injected_crowd {
    render_case healthy;
    std::vector<injected> all;
    std::size_t bad = 0, drawn = 0;

    injected_crowd(int width, int height, std::size_t parameters)
        : healthy(faint_crowd(120, crowd_size, width, height)) {
        for (std::size_t k = 0; k < 3; ++k)
            healthy.parameters[0][3 * injected_index + k] *= 0.1;  // in the image
        REQUIRE(reference().project(healthy)[injected_index].drawn);
        for (std::size_t p = 0; p < parameters; ++p)
            for (std::size_t k = 0; k < static_cast<std::size_t>(gs::parameter_width[p]); ++k)
                for (const double value : injected_values) {
                    const std::size_t element =
                        k + injected_index * static_cast<std::size_t>(gs::parameter_width[p]);
                    all.push_back(injected{p, element, value});
                    judge(all.back());
                }
    }

    render_case with(const injected& one) const {
        render_case q = healthy;
        q.parameters[one.parameter][one.element] = one.value;
        return q;
    }

  private:
    void judge(injected& one) {
        const render_case q = with(one);
        one.is_bad = is_bad(q, injected_index);
        one.is_drawn = !one.is_bad && reference().project(q)[injected_index].drawn;
        if (one.is_drawn) one.weights = off_thresholds(q, 1e-3);
        if (one.is_drawn) one.render = reference().render(q).render;
        bad += one.is_bad ? 1 : 0;
        drawn += one.is_drawn ? 1 : 0;
    }
};

/// What a backend makes otherwise of the projection; `before` is that of the healthy crowd.
std::string wrong_projection(const std::vector<projected_splat>& found,
                             const std::vector<projected_splat>& before, const injected& one) {
    std::string said;
    if (found[injected_index].drawn != one.is_drawn)
        said += one.is_drawn ? "valid, but culled; " : "to be culled, but drawn; ";
    for (std::size_t i = 0; i < crowd_size; ++i)
        if (i != injected_index && found[i] != before[i]) said += "another splat of a healthy one; ";
    return said;
}

void check_nothing(const std::string& said, const injected& one) {
    if (said.empty()) return;
    CAPTURE(parameter_names[one.parameter]);
    CAPTURE(one.element);
    CAPTURE(one.value);
    CHECK(said == "");
}

}  // namespace

TEST_CASE("NaN injection: 22 values in every parameter of one Gaussian of a crowd") {
    const injected_crowd injected(8, 4, gs::parameter_count);
    REQUIRE(injected.all.size() == 22 * 59);
    on_each_variant([&](const backend& b, accumulator how) {
        render_case rest = without(injected.healthy, injected_index);
        rest.how = how;
        const render_result alone = b.render(rest);
        const std::vector<projected_splat> before = b.project(injected.healthy);
        for (const auto& one : injected.all) {
            render_case q = injected.with(one);
            q.how = how;
            std::string said = wrong_projection(b.project(q), before, one);
            const render_result a = b.render(q);
            if (!all_finite(a)) said += "not finite; ";
            if (!one.is_drawn) said += harm(a, alone, injected_index, is_loose(b, how));
            if (one.is_drawn && !alike(a.render, one)) said += "another image than in double; ";
            check_nothing(said, one);
        }
        CHECK(largest(alone.gradients[0]) > 0);
    });
    // Both kinds are many.
    CHECK(injected.bad * 10 > injected.all.size());
    CHECK(injected.drawn * 2 > injected.all.size());
    remark("a crowd of " + std::to_string(crowd_size) + "; " + std::to_string(injected.all.size()) +
           " cases: " + std::to_string(injected.bad) + " of no Gaussian, " + std::to_string(injected.drawn) +
           " drawn");
}

TEST_CASE("NaN injection: 22 values in place, shape and opacity, in an image of six tiles") {
    const injected_crowd injected(40, 24, 4);
    REQUIRE(injected.all.size() == 22 * 11);
    on_each_backend([&](const backend& b) {
        const render_result alone = b.render(without(injected.healthy, injected_index));
        const std::vector<projected_splat> before = b.project(injected.healthy);
        for (const auto& one : injected.all) {
            const render_case q = injected.with(one);
            std::string said = wrong_projection(b.project(q), before, one);
            const render_result a = b.render(q);
            if (!all_finite(a)) said += "not finite; ";
            if (!one.is_drawn && a.render != alone.render) said += "another image; ";
            if (one.is_drawn && !alike(a.render, one)) said += "another image than in double; ";
            check_nothing(said, one);
        }
    });
}
