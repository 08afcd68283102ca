// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <vector>
#include <warpagg/segmented_sum.hpp>
#include <warpagg/warp/simd.hpp>

TEST_CASE("segmented sum") {
    //! [segmented sum]
    using tiles = warpagg::segmented_sum_tiles<float>;
    const std::vector<unsigned> keys{0, 0, 2, 2, 2};  // sorted stably
    const std::vector<float> values{1, 2, 1e8f, 3, -1e8f};
    const auto n = static_cast<unsigned>(keys.size());
    std::vector<float> sums(3), edge_sums(2 * tiles::tiles(n));
    std::vector<unsigned> edge_keys(2 * tiles::tiles(n));
    const tiles sum{keys.data(), values.data(), n, sums.data(), edge_keys.data(), edge_sums.data()};
    for (unsigned i = 0; i < tiles::tiles(n); ++i)
        sum(warpagg::emulator::lanes{}, i);  // on a GPU, one warp each
    const warpagg::segmented_sum_fixup<float> fixup{edge_keys.data(), edge_sums.data(), edge_keys.size(),
                                                    sums.data()};
    for (std::size_t edge = 0; edge < edge_keys.size(); ++edge) fixup(edge);  // then one thread each
    // sums: 3, 0, 0 (the sum of 1e8, 3 and -1e8 in this order, in float)
    //! [segmented sum]
    CHECK(sums[0] == 3);
    CHECK(sums[1] == 0);
    CHECK(sums[2] == 0);
}
