// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "poses/video_frames.hpp"

using namespace gs::poses;

TEST_CASE("sharpness is the variance of the Laplacian") {
    // The inner pixels of a 4x3 image are 8 and 2, and their neighbors are 0.
    const std::vector<std::uint8_t> gray{0, 0, 0, 0, 0, 8, 2, 0, 0, 0, 0, 0};
    const double left = 4 * 8 - 2, right = 4 * 2 - 8, mean = (left + right) / 2;
    CHECK(sharpness(gray, 4, 3) ==
          doctest::Approx(((left - mean) * (left - mean) + (right - mean) * (right - mean)) / 2));
}

TEST_CASE("sharpness falls with blur and ignores constant slopes") {
    constexpr int size = 32;
    std::vector<std::uint8_t> edge, slope;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            edge.push_back(x < size / 2 ? 0 : 240);
            slope.push_back(static_cast<std::uint8_t>(5 * x + 2 * y));
        }
    auto blurred = edge;
    for (std::size_t i = 1; i + 1 < edge.size(); ++i)
        blurred[i] = static_cast<std::uint8_t>((edge[i - 1] + edge[i] + edge[i + 1]) / 3);
    CHECK(sharpness(blurred, size, size) > 0);
    CHECK(sharpness(edge, size, size) > 2 * sharpness(blurred, size, size));
    CHECK(sharpness(slope, size, size) == doctest::Approx(0));
}

TEST_CASE("each window contributes the index of its largest value") {
    const std::vector<double> values{1, 5, 2, 9, 3, 4, 8};
    CHECK(largest_of_each_window(values, 2) == std::vector<std::size_t>{1, 3});
    CHECK(largest_of_each_window(values, 3) == std::vector<std::size_t>{1, 3, 6});
    CHECK(largest_of_each_window(values, 100) == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6});
    CHECK(largest_of_each_window({}, 3).empty());
}
