// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
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

double squared_distance(const float* a, const float* b, std::size_t width) {
    double sum = 0;
    for (std::size_t j = 0; j < width; ++j)
        sum += (double(a[j]) - double(b[j])) * (double(a[j]) - double(b[j]));
    return sum;
}

/// Returns the mean squared distance of the points to their centroids.
double mean_error(const std::vector<float>& points, std::size_t width, const clustering& c) {
    double sum = 0;
    for (std::size_t i = 0; i < c.labels.size(); ++i)
        sum += squared_distance(&points[i * width], &c.centroids[c.labels[i] * width], width);
    return sum / static_cast<double>(c.labels.size());
}

}  // namespace

TEST_CASE("k_means: each point of few is its own centroid") {
    for (const k_means_function k_means : devices())
        for (const std::size_t count : {1, 2, 15, 16, 17, 100}) {
            CAPTURE(count);
            const std::vector<float> points = random_points(count, 9);
            const clustering c = k_means(points, 9, 1000);
            REQUIRE(c.labels.size() == count);
            CHECK(c.centroids.size() == count * 9);
            CHECK(mean_error(points, 9, c) < 1e-12);
        }
}

TEST_CASE("k_means: no points have no centroids") {
    for (const k_means_function k_means : devices()) CHECK(k_means({}, 9, 10).labels.empty());
}

TEST_CASE("k_means: separate clusters are found exactly") {
    for (const k_means_function k_means : devices()) {
        std::vector<float> points;
        const std::vector<float> noise = random_points(4000, 3);
        for (std::size_t i = 0; i < 4000; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                points.push_back(100 * static_cast<float>((i % 8) >> j & 1) + 0.01f * noise[3 * i + j]);
        const clustering c = k_means(points, 3, 64);
        CHECK(c.centroids.size() <= 64 * 3);
        CHECK(mean_error(points, 3, c) < 0.0001);
    }
}

TEST_CASE("k_means: equal points share a centroid with their value") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points(300 * 24, 0.25f);
        const clustering c = k_means(points, 24, 50);
        CHECK(mean_error(points, 24, c) == 0);
    }
}

TEST_CASE("k_means: more centroids reduce the error, and no centroid exceeds the number asked for") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(5000, 9);
        double before = std::numeric_limits<double>::max();
        for (const std::size_t most : {1, 10, 64, 500, 3000}) {
            CAPTURE(most);
            const clustering c = k_means(points, 9, most);
            CHECK(c.centroids.size() <= most * 9);
            CHECK(c.centroids.size() >= most * 9 * 9 / 10);
            CHECK(*std::ranges::max_element(c.labels) < most);
            const double error = mean_error(points, 9, c);
            CHECK(error < before);
            before = error;
        }
        // One centroid is the mean, whose error is the variance: a third for each value.
        CHECK(mean_error(points, 9, k_means(points, 9, 1)) == doctest::Approx(3).epsilon(0.03));
    }
}

TEST_CASE("k_means: every centroid is the mean of its points after the last move, or close to it") {
    for (const k_means_function k_means : devices()) {
        const std::vector<float> points = random_points(3000, 9);
        const clustering c = k_means(points, 9, 100);
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
        const clustering a = k_means(points, 45, 200), b = k_means(points, 45, 200);
        CHECK(a.centroids == b.centroids);
        CHECK(a.labels == b.labels);
    }
}
