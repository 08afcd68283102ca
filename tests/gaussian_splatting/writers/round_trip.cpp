// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "round_trip.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"

namespace gs_test {
namespace {

std::size_t nearest(const float* position, const gs::gaussians& among) {
    std::size_t found = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < among.count(); ++i) {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double difference = double(position[k]) - double(among.mean[3 * i + k]);
            square += difference * difference;
        }
        if (square < least) {
            least = square;
            found = i;
        }
    }
    return found;
}

double largest_difference(const float* a, const float* b, std::size_t count) {
    double largest = 0;
    for (std::size_t k = 0; k < count; ++k)
        largest = std::max(largest, std::abs(double(a[k]) - double(b[k])));
    return largest;
}

/// Returns the largest difference of two rotations' components. q and -q are the same rotation.
double rotation_difference(const float* a, const float* b) {
    double length_a = 0, length_b = 0, dot = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        length_a = std::hypot(length_a, double(a[k]));
        length_b = std::hypot(length_b, double(b[k]));
        dot += double(a[k]) * double(b[k]);
    }
    double largest = 0;
    for (std::size_t k = 0; k < 4; ++k)
        largest = std::max(largest,
                           std::abs(double(a[k]) / length_a - (dot < 0 ? -1 : 1) * double(b[k]) / length_b));
    return largest;
}

double alpha(float logit) { return 1 / (1 + std::exp(-double(logit))); }

}  // namespace

gs::gaussians random_model(std::size_t count, int sh_degree, unsigned seed) {
    gs::gaussians model;
    model.sh_degree = sh_degree;
    std::mt19937 random(seed);
    const auto fill = [&](std::vector<float>& values, int width, float low, float high) {
        values.resize(count * static_cast<std::size_t>(width));
        for (float& value : values)
            value = low + (high - low) * static_cast<float>(double(random()) / 4294967296.0);
    };
    fill(model.mean, 3, -2, 2);
    fill(model.log_scale, 3, -6, -1);
    fill(model.quaternion, 4, -3, 3);
    fill(model.opacity, 1, -4, 4);
    fill(model.sh_constant, 3, -1.77f, 1.77f);
    fill(model.sh_rest, model.rest_width(), -0.5f, 0.5f);
    return model;
}

void check_same_gaussians(const gs::gaussians& expected, const gs::gaussians& found, const precision& bound) {
    REQUIRE(found.count() == expected.count());
    if (expected.count() == 0) return;  // glTF does not keep the SH degree of an empty model
    REQUIRE(found.sh_degree == expected.sh_degree);
    const auto width = static_cast<std::size_t>(expected.rest_width());
    std::vector<bool> seen(found.count());
    for (std::size_t i = 0; i < expected.count(); ++i) {
        CAPTURE(i);
        const std::size_t j = nearest(&expected.mean[3 * i], found);
        CHECK_FALSE(seen[j]);
        seen[j] = true;
        CHECK(largest_difference(&expected.mean[3 * i], &found.mean[3 * j], 3) <= bound.position);
        CHECK(largest_difference(&expected.log_scale[3 * i], &found.log_scale[3 * j], 3) <= bound.log_scale);
        CHECK(rotation_difference(&expected.quaternion[4 * i], &found.quaternion[4 * j]) <= bound.rotation);
        CHECK(std::abs(alpha(expected.opacity[i]) - alpha(found.opacity[j])) <= bound.opacity);
        CHECK(largest_difference(&expected.sh_constant[3 * i], &found.sh_constant[3 * j], 3) <= bound.color);
        if (width > 0)
            CHECK(largest_difference(&expected.sh_rest[i * width], &found.sh_rest[j * width], width) <=
                  bound.sh);
    }
}

gs::gaussians read_back(const gs::writer& format, const gs::gaussians& model,
                        const gs::write_options& options) {
    const temporary_folder folder;
    const auto file = folder / ("model" + std::string(format.endings[0]));
    format.write(file, model, options);
    return format.read(file);
}

}  // namespace gs_test
