// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "healthy.hpp"

#include <cmath>

#include "bounds.hpp"
#include "cases.hpp"

namespace hard_cases {

render_case faint_crowd(unsigned seed, std::size_t count, int width, int height) {
    render_case q = random_case(seed, count, width, height, 3);
    for (double& o : q.parameters[3]) o = static_cast<float>(-3.5 + 0.25 * o);
    return q;
}

std::string harm(const render_result& with, const render_result& rest, std::size_t index, bool loosely) {
    std::string said;
    if (with.render != rest.render) said += "another image; ";
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        const auto width = static_cast<std::size_t>(gs::parameter_width[p]);
        const double slack = loosely ? 1e-5 * largest(rest.gradients[p]) : 0;
        for (std::size_t i = 0; i < with.gradients[p].size(); ++i) {
            const std::size_t g = i / width;
            const double expected = g == index ? 0 : rest.gradients[p][i - (g > index ? width : 0)];
            if (std::abs(with.gradients[p][i] - expected) <= (g == index ? 0 : slack)) continue;
            said += "another gradient of " + parameter_names[p] + " of Gaussian " + std::to_string(g) + "; ";
            break;
        }
    }
    return said;
}

bool is_loose(const backend& b, accumulator how) { return b.name == "cuda" && how == gs::lab::per_lane; }

}  // namespace hard_cases
