// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"

TEST_CASE("parallel: each index is visited once, and the exception of the lowest one is thrown") {
    for (const std::size_t count : {0, 1, 4095, 4096, 4097, 100000}) {
        std::vector<int> visits(count);
        gs::for_each_index_in_parallel(count, [&](std::size_t i) { ++visits[i]; });
        CHECK(std::ranges::all_of(visits, [](int n) { return n == 1; }));
    }
    for (int repetition = 0; repetition < 20; ++repetition)
        CHECK_THROWS_WITH_AS(gs::for_each_index_in_parallel(100000,
                                                            [](std::size_t i) {
                                                                if (i % 1000 == 777)
                                                                    throw gs::error(std::to_string(i));
                                                            }),
                             "777", gs::error);
}

TEST_CASE("parallel: sorting orders any number of values") {
    for (const std::uint32_t count : {0u, 1u, 2u, 15u, 16u, 17u, 1000u, 100003u}) {
        std::vector<std::uint32_t> values(count);
        for (std::uint32_t i = 0; i < count; ++i) values[i] = (i * 2654435761u) >> 8;
        std::vector<std::uint32_t> expected = values;
        std::ranges::sort(expected);
        gs::sort_in_parallel(values);
        CHECK(values == expected);
    }
}

TEST_CASE("parallel: zeros replace all values, on many pages or none") {
    std::vector<float> values(3, 1.0f);
    for (const std::size_t count : {std::size_t{5}, std::size_t{0}, std::size_t{3} << 20}) {
        gs::assign_zeros(values, count);
        CHECK(values == std::vector<float>(count));
        std::ranges::fill(values, 1.0f);
    }
}
