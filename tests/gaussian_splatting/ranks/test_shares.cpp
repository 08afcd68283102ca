// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ranks/shares.hpp"
#include "ranks/windows.hpp"

using gs::ranks::share;
using gs::ranks::shared_array;
using gs::ranks::shares;
using gs::ranks::windows;

TEST_CASE("shares: consecutive whole blocks, which differ by at most one block") {
    for (const std::size_t items : {0u, 1u, 31u, 32u, 33u, 95u, 1000u})
        for (const int ranks : {1, 2, 3, 7}) {
            CAPTURE(items);
            CAPTURE(ranks);
            const shares all(items, 32, ranks);
            std::size_t end = 0, least = items, most = 0;
            for (int r = 0; r < ranks; ++r) {
                const share own = all.of(r);
                CHECK(own.first == end);
                CHECK((own.first % 32 == 0 || own.count() == 0));
                end = own.last;
                const std::size_t blocks = (own.count() + 31) / 32;
                least = r == 0 ? blocks : std::min(least, blocks);
                most = std::max(most, blocks);
            }
            CHECK(end == items);
            CHECK(most - least <= 1);
        }
}

TEST_CASE("windows: each rank knows where the windows of all others are") {
    // Rank 0 sends 1 and 2 items, and rank 1 sends 3 and 4.
    const windows all(std::vector<std::size_t>{1, 2, 3, 4}, 2);
    CHECK(all.ranks() == 2);
    CHECK(all.sent_by(0).of(1) == share{1, 3});
    CHECK(all.sent_by(1).of(0) == share{0, 3});
    CHECK(all.received_by(0).of(1) == share{1, 4});
    CHECK(all.received_by(1).of(1) == share{2, 6});
    CHECK(all.moved() == 2 + 3);
    CHECK(all.reversed().sent_by(0).of(1) == all.received_by(0).of(1));
    CHECK(all.reversed().received_by(1).of(0) == all.sent_by(1).of(0));
}

TEST_CASE("shares: parts of arrays with several values per item, padding, or fewer items") {
    const shares all(70, 32, 2);  // blocks 0 and 1 to 2
    CHECK(all.of(0) == share{0, 32});
    CHECK(all.of(1) == share{32, 70});
    CHECK(all.of(0, 96, 3 * 96) == share{0, 96});
    CHECK(all.of(1, 96, 3 * 96) == share{96, 288});
    CHECK(all.of(1, 32, 70) == share{32, 70});
    CHECK(all.of(1, 32, 32) == share{32, 32});
    CHECK(all.of(0, 32, 20) == share{0, 20});

    std::vector<std::uint32_t> values(70);
    const auto array = shared_array::of(values.data(), 32, values.size());
    CHECK(array.bytes == 280);
    CHECK(array.part(all, 1).size() == 38 * 4);
    CHECK(array.part(all, 1).data() == reinterpret_cast<std::byte*>(values.data() + 32));
}

TEST_CASE("shares: the parts of a piece of an array follow each other from its beginning") {
    const shares all(70, 32, 2);  // blocks 0 and 1 to 2
    const std::size_t size = 3 * 96;
    CHECK(all.within({0, size}, 96, size).of(1) == share{96, 288});
    CHECK(all.within({48, 144}, 96, size).of(0) == share{0, 48});
    CHECK(all.within({48, 144}, 96, size).of(1) == share{48, 96});
    CHECK(all.within({0, 96}, 96, size).of(1) == share{96, 96});
    CHECK(all.within({192, 288}, 96, size).of(0) == share{0, 0});
    CHECK(all.within({192, 288}, 96, size).of(1) == share{0, 96});
    CHECK(all.within({0, 0}, 96, 0).of(1) == share{0, 0});
}
