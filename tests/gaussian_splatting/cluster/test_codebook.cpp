// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cluster/codebook.hpp"

namespace {

using gs::cluster::codebook;

double mean_squared_error(const codebook& book, const std::vector<float>& values) {
    double sum = 0;
    for (const float x : values) {
        const double difference = double(x) - double(book.values()[book.nearest(x)]);
        sum += difference * difference;
    }
    return sum / static_cast<double>(values.size());
}

}  // namespace

TEST_CASE("codebook: up to 256 different values are kept exactly") {
    std::vector<float> values;
    for (int i = 0; i < 1000; ++i) values.push_back(static_cast<float>(i % 256));
    const codebook book(values);
    for (const float x : values) CHECK(book.values()[book.nearest(x)] == x);
    CHECK(std::ranges::is_sorted(book.values()));
}

TEST_CASE("codebook: one value, and none") {
    const codebook one(std::vector<float>{-30.0f});
    CHECK(one.values()[one.nearest(-30)] == -30.0f);
    CHECK(one.values()[one.nearest(7)] == -30.0f);
    const codebook none(std::vector<float>{});
    CHECK(none.values()[none.nearest(1)] == 0.0f);
}

TEST_CASE("codebook: the error is close to the best for a normal distribution, even with an outlier") {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> values(200000);
    for (float& x : values) x = normal(random);
    // The best quantizer of n levels has the error sqrt(3) pi / 2 / n^2 for a variance of 1.
    const double best = std::sqrt(3.0) * 3.14159265 / 2 / (256.0 * 256);
    CHECK(mean_squared_error(codebook(values), values) < 1.02 * best);
    // An outlier takes one of the numbers.
    for (const float outlier : {100.0f, -1e6f, 1e30f}) {
        CAPTURE(outlier);
        std::vector<float> more = values;
        more.push_back(outlier);
        CHECK(mean_squared_error(codebook(more), more) < 1.03 * best);
    }
}

TEST_CASE("codebook: a sample of very many values stands for all coordinates and for the extremes") {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> values(std::size_t{6} << 19);  // so that the sample takes one of six
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = 100.0f * static_cast<float>(i % 3) + normal(random);
    values[1] = 1e6f;
    const codebook book(values);
    CHECK(book.values()[book.nearest(1e6f)] == 1e6f);
    // Each of the three distributions gets a third of the numbers.
    const double best = std::sqrt(3.0) * 3.14159265 / 2 / (85.0 * 85);
    CHECK(mean_squared_error(book, values) < 1.05 * best);
}

TEST_CASE("codebook: no other codebook of few values has a smaller error") {
    // Of 258 squares, three share a number. 0, 1 and 4 do, whose mean is 5 / 3.
    std::vector<float> values;
    for (int i = 0; i < 258; ++i) values.push_back(static_cast<float>(i * i));
    const double error = mean_squared_error(codebook(values), values) * 258;
    CHECK(error == doctest::Approx(25.0 / 9 + 4.0 / 9 + 49.0 / 9).epsilon(1e-6));
}

TEST_CASE("codebook: the index is that of the nearest number") {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    std::vector<float> values(5000);
    for (float& x : values) x = normal(random);
    const codebook book(values);
    for (const float x : values) {
        double least = 1e9;
        for (const float number : book.values())
            least = std::min(least, std::abs(double(x) - double(number)));
        CHECK(std::abs(double(x) - double(book.values()[book.nearest(x)])) <= least + 1e-6);
    }
}
