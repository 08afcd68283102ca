// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "cluster/k_means.hpp"

namespace {

using gs::cluster::clustering;
using gs::cluster::k_means_function;

std::vector<k_means_function> devices() {
    std::vector<k_means_function> all{gs::cluster::k_means_on_cpu};
#if defined(WARPAGG_TEST_CUDA)
    all.push_back(gs::cluster::k_means_on_cuda);
#endif
    return all;
}

std::vector<float> random_points(std::size_t count, std::size_t width) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> points(count * width);
    for (float& x : points) x = uniform(random);
    return points;
}

std::vector<float> equal_weights(std::size_t count) { return std::vector<float>(count, 1); }

std::vector<float> random_weights(std::size_t count) {
    std::vector<float> weights = random_points(count, 1);
    for (float& w : weights) w = w * w;
    return weights;
}

double squared_distance(const float* a, const float* b, std::size_t width) {
    double sum = 0;
    for (std::size_t j = 0; j < width; ++j)
        sum += (double(a[j]) - double(b[j])) * (double(a[j]) - double(b[j]));
    return sum;
}

/// Returns the mean squared distance to their centroids of the points that `chosen` accepts.
double mean_error_of(const std::vector<float>& points, std::size_t width, const clustering& c,
                     const auto& chosen) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < c.labels.size(); ++i)
        if (chosen(i)) {
            sum += squared_distance(&points[i * width], &c.centroids[c.labels[i] * width], width);
            ++count;
        }
    return sum / count;
}

double mean_error(const std::vector<float>& points, std::size_t width, const clustering& c) {
    return mean_error_of(points, width, c, [](std::size_t) { return true; });
}

}  // namespace

TEST_CASE("k_means: each point of few is its own centroid") {
    for (const k_means_function k_means : devices())
        for (const std::size_t count : {1, 2, 15, 16, 17, 100}) {
            CAPTURE(count);
            const std::vector<float> points = random_points(count, 9);
            const clustering c = k_means(points, 9, equal_weights(count), 1000);
            REQUIRE(c.labels.size() == count);
            CHECK(c.centroids.size() == count * 9);
            CHECK(mean_error(points, 9, c) < 1e-12);
        }
}

TEST_CASE("k_means: no points have no centroids") {
    for (const k_means_function k_means : devices()) CHECK(k_means({}, 9, {}, 10).labels.empty());
}

TEST_CASE("k_means: separate clusters are found exactly") {
    for (const k_means_function k_means : devices()) {
        std::vector<float> points;
        const std::vector<float> noise = random_points(4000, 3);
        for (std::size_t i = 0; i < 4000; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                points.push_back(100 * static_cast<float>((i % 8) >> j & 1) + 0.01f * noise[3 * i + j]);
        const clustering c = k_means(points, 3, equal_weights(4000), 64);
        CHECK(c.centroids.size() <= 64 * 3);
        CHECK(mean_error(points, 3, c) < 0.0001);
    }
}

TEST_CASE("k_means: equal points share a centroid with their value") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points(300 * 24, 0.25f);
        const clustering c = k_means(points, 24, equal_weights(300), 50);
        CHECK(mean_error(points, 24, c) == 0);
    }
}

TEST_CASE("k_means: more centroids reduce the error, and no centroid exceeds the number asked for") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(5000, 9);
        double before = std::numeric_limits<double>::max();
        for (const std::size_t most : {1, 10, 64, 500, 3000}) {
            CAPTURE(most);
            const clustering c = k_means(points, 9, equal_weights(5000), most);
            CHECK(c.centroids.size() <= most * 9);
            CHECK(c.centroids.size() >= most * 9 * 9 / 10);
            CHECK(*std::ranges::max_element(c.labels) < most);
            const double error = mean_error(points, 9, c);
            CHECK(error < before);
            before = error;
        }
        // One centroid is the mean, whose error is the variance: a third for each value.
        CHECK(mean_error(points, 9, k_means(points, 9, equal_weights(5000), 1)) ==
              doctest::Approx(3).epsilon(0.03));
    }
}

TEST_CASE("k_means: every centroid is the mean of its points after the last move, or close to it") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(3000, 9);
        const clustering c = k_means(points, 9, equal_weights(3000), 100);
        std::vector<double> sums(c.centroids.size()), counts(c.centroids.size() / 9);
        for (std::size_t i = 0; i < 3000; ++i) {
            ++counts[c.labels[i]];
            for (std::size_t j = 0; j < 9; ++j) sums[c.labels[i] * 9 + j] += double(points[9 * i + j]);
        }
        double moved = 0;
        for (std::size_t k = 0; k < sums.size(); ++k)
            if (counts[k / 9] > 0) {
                const double difference = sums[k] / counts[k / 9] - double(c.centroids[k]);
                moved += difference * difference * counts[k / 9];
            }
        CHECK(moved / 3000 < 0.02 * mean_error(points, 9, c));
    }
}

TEST_CASE("k_means: repeated runs have the same result") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(2000, 45);
        const std::vector<float> weights = random_weights(2000);
        const clustering a = k_means(points, 45, weights, 200), b = k_means(points, 45, weights, 200);
        CHECK(a.centroids == b.centroids);
        CHECK(a.labels == b.labels);
    }
}

TEST_CASE("k_means: a centroid is the weighted mean of its points") {
    for (const k_means_function k_means : devices()) {
        const clustering c = k_means({0, 8, 1, 8}, 2, {0.75f, 0.25f}, 1);
        CHECK(c.centroids == std::vector<float>{0.25f, 8});
        CHECK(c.labels == std::vector<std::uint32_t>{0, 0});
    }
}

TEST_CASE("k_means: heavy points have small errors") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(5000, 9);
        const auto is_heavy = [](std::size_t i) { return i % 100 == 99; };
        std::vector<float> weights(5000, 0.001f);
        for (std::size_t i = 0; i < weights.size(); ++i)
            if (is_heavy(i)) weights[i] = 1;
        const clustering equal = k_means(points, 9, equal_weights(5000), 200);
        const clustering weighted = k_means(points, 9, weights, 200);
        CHECK(mean_error_of(points, 9, weighted, is_heavy) < 0.1 * mean_error_of(points, 9, equal, is_heavy));
        // The others pay for it, but not much.
        CHECK(mean_error(points, 9, weighted) < 1.2 * mean_error(points, 9, equal));
    }
}

TEST_CASE("k_means: points of weight 0 move no centroid") {
    for (const k_means_function k_means : devices()) {
        std::vector<float> points = random_points(1000, 9), weights(1000, 1);
        for (std::size_t i = 0; i < weights.size(); ++i)
            if (i % 2 == 0) {
                weights[i] = 0;
                for (std::size_t j = 0; j < 9; ++j) points[9 * i + j] += 100;
            }
        const clustering c = k_means(points, 9, weights, 1);
        for (const float x : c.centroids) CHECK(std::abs(x) < 1);
    }
}

TEST_CASE("k_means: without any weight, the centroids are points") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(300, 1);
        const clustering c = k_means(points, 1, std::vector<float>(300, 0), 20);
        CHECK(c.centroids.size() == 20);
        for (const float x : c.centroids) CHECK(std::ranges::find(points, x) != points.end());
        CHECK(mean_error(points, 1, c) < 0.1);
    }
}

TEST_CASE("k_means: the value of equal weights does not matter") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(2000, 9);
        const clustering one = k_means(points, 9, equal_weights(2000), 100);
        const clustering small = k_means(points, 9, std::vector<float>(2000, 0x1p-10f), 100);
        CHECK(one.centroids == small.centroids);
        CHECK(one.labels == small.labels);
    }
}
