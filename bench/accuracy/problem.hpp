// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>
#include <warpagg/atomic.hpp>

/// Values for the lanes of warps, one after the other, and the sums that they go to.
struct problem {
    static constexpr std::uint32_t nowhere = 0xffffffffu;  ///< key of a lane that has nothing to add

    std::vector<float> values;
    std::vector<std::uint32_t> keys;
    std::uint32_t sums;

    void shuffle(std::mt19937_64& random);
};

/// Appends n values.
using generator = std::function<void(std::size_t n, std::mt19937_64&, std::vector<float>&)>;
/// By name: uniform, lognormal, of ranges of exponents, and of condition numbers from 1 to 1e12.
std::map<std::string, generator> generators();

/// About n values that go to `sums` sums, as many to each, or by Zipf's law; of the lanes this share is
/// active.
problem draw(const generator& values_of, std::size_t n, std::uint32_t sums, bool zipf, double active,
             std::mt19937_64& random);

/// The properties of a sum that errors and bounds refer to.
struct sizes {
    double n = 0, magnitude = 0, largest = 0, sum = 0;
    warpagg::accumulator<warpagg::accumulate::exact> exact;

    /// The distance of x from the exact sum, rounded once.
    double minus(float x) const;
};
std::vector<sizes> sizes_of(const problem& p);
