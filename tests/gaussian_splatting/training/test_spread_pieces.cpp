// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "model/spread_pieces.hpp"

using gs::spread_pieces;

TEST_CASE("spread_pieces: all places differ, and whole pieces stay together") {
    constexpr std::size_t length = spread_pieces::piece_length;
    for (const std::size_t count : std::vector<std::size_t>{0, 1, length - 1, length, 2 * length,
                                                            3 * length + 5, 100 * length, 997 * length + 1}) {
        CAPTURE(count);
        const spread_pieces pieces(count);
        std::vector<bool> is_taken(count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t place = pieces.place_of(i);
            REQUIRE(place < count);
            REQUIRE_FALSE(is_taken[place]);
            is_taken[place] = true;
            if (i % length != 0 && i < count / length * length) REQUIRE(place == pieces.place_of(i - 1) + 1);
        }
    }
}

TEST_CASE("spread_pieces: consecutive Gaussians belong to all ranks in about equal parts") {
    for (const std::size_t pieces : std::vector<std::size_t>{40, 128, 1000, 4181})
        for (const std::size_t ranks : std::vector<std::size_t>{2, 3, 4, 8}) {
            CAPTURE(pieces);
            CAPTURE(ranks);
            const spread_pieces spread(pieces * spread_pieces::piece_length);
            const std::size_t shown = pieces / 2;  // consecutive pieces that a view shows
            for (std::size_t first = 0; first + shown <= pieces;
                 first += std::max<std::size_t>(1, pieces / 10)) {
                std::vector<std::size_t> of_rank(ranks);
                for (std::size_t piece = first; piece < first + shown; ++piece)
                    ++of_rank[spread.place_of(piece * spread_pieces::piece_length) /
                              spread_pieces::piece_length * ranks / pieces];
                const double mean = static_cast<double>(shown) / static_cast<double>(ranks);
                CHECK(static_cast<double>(std::ranges::max(of_rank)) <= 1.2 * mean + 2);
            }
        }
}
