// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Scatters of many blocks, whose warps run at the same time: the sums are exact and repeat.

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>
#include <warpagg/scatter_in_blocks.hpp>

#include "../support/backends/cuda.hpp"

namespace {

using rows = warpagg::scatter_rows<std::int64_t, std::int64_t, warpagg::row_keys<unsigned>>;
constexpr unsigned n = 100'000, records = 5000, blocks = 300, warps = 8;

template <class Scatter>
__global__ void each_block(Scatter scatter) {
    extern __shared__ std::int64_t memory[];
    scatter(warpagg::cuda_warp{}, blockIdx.x, threadIdx.x / 32, memory, [] { __syncthreads(); });
}

/// Rows whose k-th most frequent key has a share of about 1 / k, or of two keys in turn. The values use
/// all bits of a word, so that sums carry.
struct inputs {
    std::vector<unsigned> keys;
    std::vector<std::int64_t> values;

    inputs(bool two_keys, unsigned width) : values(std::size_t{n} * width) {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> unit(0, 1);
        for (unsigned i = 0; i < n; ++i)
            keys.push_back(two_keys ? 7 + i % 2
                                    : static_cast<unsigned>(std::exp(unit(random) * std::log(records))) - 1);
        for (std::int64_t& v : values) v = static_cast<std::int64_t>(random());
    }
    std::vector<std::int64_t> sums(unsigned width) const {
        std::vector<std::int64_t> table(std::size_t{records} * width);
        for (std::size_t i = 0; i < values.size(); ++i) {
            std::int64_t& to = table[std::size_t{keys[i / width]} * width + i % width];
            to = warpagg::operation::sum::combine(to, values[i]);
        }
        return table;
    }
};

template <class Kernel>
void check_runs(unsigned width, unsigned slots) {
    using scatter = warpagg::scatter_in_blocks<Kernel>;
    const unsigned bytes = scatter::template memory_size<warpagg::cuda_warp>(slots) * sizeof(std::int64_t);
    for (const bool two_keys : {false, true}) {
        CAPTURE(width);
        CAPTURE(slots);
        CAPTURE(two_keys);
        const inputs in(two_keys, width);
        const auto expected = in.sums(width);
        backend::memory<unsigned> keys(in.keys);
        backend::memory<std::int64_t> values(in.values);
        for (int run = 0; run < 100; ++run) {
            backend::memory<std::int64_t> table(std::vector<std::int64_t>(expected.size()));
            const Kernel kernel{{values.data(), n, width, {keys.data(), records}, table.data()}};
            each_block<<<blocks, warps * 32, bytes>>>(scatter{kernel, slots, blocks, warps});
            check_cuda(cudaGetLastError(), "launch");
            check_cuda(cudaDeviceSynchronize(), "kernel");
            REQUIRE(table.download() == expected);
        }
    }
}

}  // namespace

TEST_SUITE_BEGIN("scatter in blocks");

TEST_CASE("100 runs of many blocks have the bits of sums in order") {
    check_runs<warpagg::scatter_narrow_rows<1, rows>>(3, 200);
    check_runs<warpagg::scatter_narrow_rows<4, rows>>(4, 300);
    check_runs<warpagg::scatter_narrow_rows<4, rows>>(12, 3);
    check_runs<warpagg::scatter_wide_rows<2, rows>>(64, 40);
}

TEST_SUITE_END();
