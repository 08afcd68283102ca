// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "model/gaussian_shares.hpp"

using gs::gaussian_shares;
using gs::ranks::share;

namespace {

/// A view that shows Gaussians from `first` to `last`, of the first `density` of each 10.
gs::ranks::shares shown_by_owner(const gs::ranks::shares& all, int ranks, std::size_t first, std::size_t last,
                                 std::size_t density = 10) {
    std::vector<std::size_t> counts;
    for (int r = 0; r < ranks; ++r) {
        std::size_t count = 0;
        for (std::size_t i = all.of(r).first; i < all.of(r).last; ++i)
            count += i >= first && i < last && i % 10 < density ? 1 : 0;
        counts.push_back(count);
    }
    return gs::ranks::shares(counts);
}

std::size_t most_of(const gs::ranks::shares& shown, int ranks) {
    std::size_t most = 0;
    for (int r = 0; r < ranks; ++r) most = std::max(most, shown.of(r).count());
    return most;
}

}  // namespace

TEST_CASE("shares of Gaussians: even until views have shown where the work is") {
    gaussian_shares shares;
    CHECK(shares.of(96, 3).of(1) == share{32, 64});
    shares.balance();
    CHECK(shares.of(96, 3).of(1) == share{32, 64});
}

TEST_CASE("shares of Gaussians: balanced shares show about as many, wherever the visible ones are") {
    constexpr std::size_t count = 100'000;
    for (const int ranks : {2, 3, 8})
        for (const std::size_t first : {0u, 10'000u, 70'000u}) {
            CAPTURE(ranks);
            CAPTURE(first);
            gaussian_shares shares;
            for (int round = 0; round < 30; ++round) {
                shares.note(shown_by_owner(shares.of(count, ranks), ranks, first, first + 30'000, 5), count,
                            ranks);
                shares.balance();
            }
            const auto shown = shown_by_owner(shares.of(count, ranks), ranks, first, first + 30'000, 5);
            const double even = 15'000.0 / ranks;
            CHECK(most_of(shown, ranks) < 1.5 * even);
            // The shares still have all Gaussians, one after the other.
            std::size_t end = 0;
            for (int r = 0; r < ranks; ++r) {
                CHECK(shares.of(count, ranks).of(r).first == end);
                end = shares.of(count, ranks).of(r).last;
            }
            CHECK(end == count);
        }
}

TEST_CASE("shares of Gaussians: shares grow alike if Gaussians are added") {
    gaussian_shares shares;
    shares.note(gs::ranks::shares(std::vector<std::size_t>{0, 3200}), 6400, 2);
    shares.balance();
    const std::size_t border = shares.of(6400, 2).of(0).last;
    CHECK(border > 3200 + 32);
    CHECK(shares.of(12'800, 2).of(0).last ==
          doctest::Approx(2.0 * static_cast<double>(border)).epsilon(0.01));
    CHECK(shares.of(12'800, 2).of(1).last == 12'800);
    CHECK(shares.of(1, 2).of(1).last == 1);
    CHECK(shares.of(0, 2).of(1) == share{0, 0});
}

TEST_CASE("shares of Gaussians: views that show none leave even shares") {
    gaussian_shares shares;
    shares.note(gs::ranks::shares(std::vector<std::size_t>{0, 0}), 6400, 2);
    shares.balance();
    CHECK(shares.of(6400, 2).of(0) == share{0, 3200});
}

TEST_CASE("shares of Gaussians: they are uneven if one rank has clearly more work") {
    gaussian_shares shares;
    CHECK_FALSE(shares.are_uneven());
    shares.note(gs::ranks::shares(std::vector<std::size_t>{3200, 3100}), 6400, 2);
    CHECK_FALSE(shares.are_uneven());
    shares.note(gs::ranks::shares(std::vector<std::size_t>{3200, 1000}), 6400, 2);
    CHECK(shares.are_uneven());
    shares.balance();
    CHECK_FALSE(shares.are_uneven());
}
