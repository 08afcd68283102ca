// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What CUDA does otherwise than the C++ library: functions that are the hardware's.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>
#include <warpagg/atomic.hpp>

#include "../support/backends/cuda.hpp"

namespace {

namespace math = warpagg::math;

enum function { power, inverse_root, quotient, capped, raised, function_count };

/// All functions, of a pair of arguments a lane.
struct evaluate {
    const float* a;
    const float* b;
    float* results;
    unsigned count;
    __device__ void operator()(const warpagg::cuda_warp& w) const {
        for (unsigned i = w.lane(); i < count; i += 32) {
            results[power * count + i] = math::exp2(b[i]);
            results[inverse_root * count + i] = math::inverse_sqrt(a[i]);
            results[quotient * count + i] = math::divide(a[i], b[i]);
            results[capped * count + i] = math::not_above(a[i], b[i]);
            results[raised * count + i] = math::not_below(a[i], b[i]);
        }
    }
};

/// Indexed by function, then by pair.
std::vector<std::vector<float>> results_of(const std::vector<float>& a, const std::vector<float>& b) {
    backend::memory<float> first(a), second(b);
    backend::memory<float> results(std::vector<float>(function_count * a.size()));
    backend::launch(evaluate{first.data(), second.data(), results.data(), static_cast<unsigned>(a.size())});
    const std::vector<float> all = results.download();
    std::vector<std::vector<float>> by_function;
    for (auto from = all.begin(); from != all.end(); from += static_cast<std::ptrdiff_t>(a.size()))
        by_function.emplace_back(from, from + static_cast<std::ptrdiff_t>(a.size()));
    return by_function;
}

/// The error of a float in units in the last place of the exact value.
double ulps(float is, double exact) {
    const double unit = std::ldexp(1.0, std::max(std::ilogb(exact), -126) - 23);
    return std::fabs(static_cast<double>(is) - exact) / unit;
}

}  // namespace

TEST_SUITE_BEGIN("math");

TEST_CASE("powers, inverse roots and quotients err by no more than they say") {
    constexpr std::size_t count = 1 << 16;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-60, 60), small(-126, 126);
    std::vector<float> a(count), b(count);
    for (std::size_t i = 0; i < count; ++i) {
        a[i] = std::exp2(exponent(random));
        b[i] = i % 2 == 0 ? small(random) : std::copysign(std::exp2(exponent(random)), small(random));
    }
    const auto results = results_of(a, b);
    for (std::size_t i = 0; i < count; ++i) {
        CAPTURE(a[i]);
        CAPTURE(b[i]);
        if (std::fabs(b[i]) < 126) {
            const double exact = std::exp2(double{b[i]});
            REQUIRE(std::fabs(double{results[power][i]} - exact) <= std::exp2(-22.5) * exact);
        }
        REQUIRE(ulps(results[inverse_root][i], 1 / std::sqrt(double{a[i]})) <= 2);
        REQUIRE(ulps(results[quotient][i], double{a[i]} / double{b[i]}) <= 1);
    }
    const auto ones = results_of(b, b);
    for (std::size_t i = 0; i < count; ++i) REQUIRE(ones[quotient][i] == 1);
}

TEST_CASE("at the ends of the range") {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto results = results_of({0x1p-126f, 0x1p126f, infinity, 0}, {-200, -infinity, 200, 0});
    CHECK(results[power] == std::vector<float>{0, 0, infinity, 1});
    CHECK(ulps(results[inverse_root][0], 0x1p63) <= 2);
    CHECK(ulps(results[inverse_root][1], 0x1p-63) <= 2);
    CHECK(results_of({0}, {3})[quotient][0] == 0);
}

TEST_CASE("a bound that is no NaN bounds a NaN") {
    const float nan = std::nanf("");
    const auto results = results_of({nan, 1, 3, -3}, {2, 2, 2, 2});
    CHECK(results[capped] == std::vector<float>{2, 1, 2, -3});
    CHECK(results[raised] == std::vector<float>{2, 2, 3, 2});
}

TEST_SUITE_END();
