// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "features/response/respond_in_model.hpp"
#include "features/response/response_kernels.hpp"
#include "model/spherical_harmonics.hpp"

namespace {

using gs::features::respond;
using gs::features::respond_in_model;
using gs::features::response_at;

const std::vector<float> increments{0.1f,  0.3f, 0.2f, 0.3f,  0.1f,  0.02f, 0.5f, 0.1f,
                                    0.08f, 0.3f, 0.4f, 0.25f, 0.15f, 0.1f,  0.1f};

/// The color of the first Gaussian, whose model has SH degree 1, from a direction.
double color_of(const gs::gaussians& of, std::size_t c, const glm::dvec3& direction) {
    double basis[4], color = 0.5 + gs::sh_c0 * static_cast<double>(of.sh_constant[c]);
    gs::sh_basis<double>(1, direction, basis);
    for (std::size_t k = 1; k < 4; ++k) color += basis[k] * static_cast<double>(of.sh_rest[3 * (k - 1) + c]);
    return color;
}

float shown_color(float color, std::size_t c) {
    return respond(color, increments.data() + response_at(static_cast<unsigned>(c), 0));
}

float constant_color(float coefficient) { return 0.5f + static_cast<float>(gs::sh_c0) * coefficient; }

}  // namespace

TEST_CASE("response: a saved model shows about the colors of the curve, from all directions") {
    gs::gaussians model;
    model.sh_degree = 1;
    model.opacity = {0, 0};
    // The first Gaussian has small changes with the direction. The second one is beyond white and black.
    for (const float color : {0.2f, 0.5f, 0.8f, 1.1f, 0.5f, -0.1f})
        model.sh_constant.push_back(gs::sh_from_color(color));
    for (std::size_t i = 0; i < 2 * 9; ++i)
        model.sh_rest.push_back(i < 9 ? 0.01f * static_cast<float>(i) - 0.04f : 0.0f);
    model.sky.assign(gs::sky_width, 0.0f);  // gray
    gs::gaussians shown = model;
    respond_in_model(increments.data(), shown);
    double most = 0;
    for (const glm::dvec3& d : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0, 0.8)})
        for (std::size_t c = 0; c < 3; ++c) {
            const double color = color_of(model, c, d);
            const auto expected = static_cast<double>(shown_color(static_cast<float>(color), c));
            CHECK(std::abs(color_of(shown, c, d) - expected) < 0.003);
            most = std::max(most, std::abs(expected - color));
        }
    CHECK(most > 0.02);  // the curve is no identity
    for (std::size_t c = 0; c < 3; ++c)
        CHECK(constant_color(shown.sky[c]) == doctest::Approx(shown_color(0.5f, c)));
    // Beyond the range, the curve goes on as a line.
    CHECK(constant_color(shown.sh_constant[3]) ==
          doctest::Approx(1 + 0.1f * 5 * increments[response_at(0, 4)]));
    CHECK(constant_color(shown.sh_constant[5]) == doctest::Approx(-0.1f * 5 * increments[response_at(2, 0)]));
    gs::gaussians same = model;
    respond_in_model(std::vector<float>(gs::features::response_width, 1.0f).data(), same);
    for (std::size_t i = 0; i < same.sh_constant.size(); ++i)
        CHECK(same.sh_constant[i] == doctest::Approx(model.sh_constant[i]).epsilon(1e-5));
}
