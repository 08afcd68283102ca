// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <vector>
#include <warpagg/scatter_in_blocks.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/serial.hpp>

using namespace warpagg;

TEST_CASE("scatter") {
    //! [scatter]
    const std::vector<unsigned> keys{2, 0, 2};
    const std::vector<float> values{1, 2, 10, 20, 100, 200};  // rows of 2
    std::vector<float> table(3 * 2);
    using rows = scatter_rows<float, float, row_keys<unsigned>>;
    const scatter_wide_rows<1, rows> add{{values.data(), 3, 2, {keys.data(), 3}, table.data()}};
    const emulator::serial w;
    for (unsigned i = 0; i < add.tiles(w.size); ++i) add(w, i);  // on a GPU, one warp each
    // table: 10, 20, 0, 0, 101, 202
    //! [scatter]
    CHECK(table == std::vector<float>{10, 20, 0, 0, 101, 202});
}

TEST_CASE("fixed point") {
    //! [fixed point]
    const std::vector<unsigned> keys{2, 0, 2, 2};
    const std::vector<float> values{1e8f, 1, 3, -1e8f};  // rows of 1
    std::vector<float> table(3);
    magnitudes largest{};               // on a GPU, clear it by cudaMemset
    std::vector<std::int64_t> sums(3);  // zeros
    using rows = scatter_rows<float, std::int64_t, row_keys<unsigned>, to_fixed_point<float>>;
    const rows all{values.data(), 4, 1, {keys.data(), 3}, sums.data(), {&largest, 4}};
    const emulator::serial w;
    largest_exponent<float>{values.data(), 4, &largest}(w, 0, 1);  // on a GPU, several warps
    const scatter_narrow_rows<1, rows> add{all};
    for (unsigned i = 0; i < add.tiles(w.size); ++i) add(w, i);
    add_fixed_point<rows>{all, table.size(), table.data()}(w, 0, 1);
    // table: 1, 0, 3, for any order of the rows
    //! [fixed point]
    CHECK(table == std::vector<float>{1, 0, 3});
}

TEST_CASE("in blocks") {
    //! [in blocks]
    std::vector<unsigned> keys(1000, 2);  // a frequent key
    keys[500] = 0;
    const std::vector<std::int64_t> values(1000, 5);  // rows of 1
    std::vector<std::int64_t> table(3);
    using rows = scatter_rows<std::int64_t, std::int64_t, row_keys<unsigned>>;
    using scatter = scatter_in_blocks<scatter_narrow_rows<1, rows>>;
    constexpr unsigned slots = 16, blocks = 2, warps = 4;
    const scatter add{{{values.data(), 1000, 1, {keys.data(), 3}, table.data()}}, slots, blocks, warps};
    // On a GPU, a kernel does this with __shared__ memory and __syncthreads().
    emulator::launch({.blocks = blocks, .threads = warps * 32}, [&](const emulator::checked& w) {
        const auto memory = w.shared<std::int64_t>(scatter::memory_size<emulator::checked>(slots));
        add(w, w.block_index(), w.thread_index() / 32, memory.data(), [&] { w.barrier(); });
    });
    // table: 5, 0, 4995
    //! [in blocks]
    CHECK(table == std::vector<std::int64_t>{5, 0, 4995});
}
