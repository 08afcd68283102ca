// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Destinations in shared memory, where the instructions for several neighbors do not go: with few active
/// lanes, with keys, and pairs of halves of which one is zero.

#include <cuda_fp16.h>
#include <doctest/doctest.h>

#include <vector>
#include <warpagg/atomic.hpp>

#include "../support/backends/cuda.hpp"

namespace {

constexpr unsigned size = 64;

struct into_a_stage {
    float* memory;
    unsigned active;
    __device__ void operator()(const warpagg::cuda_warp& w) const {
        __shared__ alignas(16) float copy[size];
        const warpagg::stage sums(memory, copy, size);
        sums.clear(w, 0, 1);
        __syncwarp();
        const float values[4] = {1, 2, 3, 4};
        warpagg::warp_reduce_atomic(w, sums.record(8), values, w.lane() < active,
                                    warpagg::policy{warpagg::staged});
        warpagg::warp_match_reduce_atomic(w, copy, 3 + w.lane() % 2, values, w.lane() < active);
        __syncwarp();
        sums.flush(w, 0, 1);
    }
};

struct halves {
    __half2* memory;
    __device__ void operator()(const warpagg::cuda_warp& w) const {
        __shared__ __half2 copy[size];
        const warpagg::stage sums(memory, copy, size);
        sums.clear(w, 0, 1);
        __syncwarp();
        const __half2 values[2] = {__floats2half2_rn(1, 0), __floats2half2_rn(0, 1)};
        warpagg::warp_reduce_atomic(w, sums.record(1), values, true, warpagg::policy{warpagg::staged});
        __syncwarp();
        sums.flush(w, 0, 1);
    }
};

}  // namespace

TEST_SUITE_BEGIN("shared memory");

TEST_CASE("a stage and a base of keys in shared memory, whatever the number of active lanes") {
    for (unsigned active = 0; active <= 32; ++active) {
        INFO("active: ", active);
        backend::memory<float> memory(std::vector<float>(size, 0.0f));
        backend::launch(into_a_stage{memory.data(), active});
        std::vector<float> expected(size, 0.0f);
        for (unsigned lane = 0; lane < active; ++lane)
            for (unsigned i = 0; i < 4; ++i) {
                expected[8 + i] += static_cast<float>(i + 1);
                expected[4 * (3 + lane % 2) + i] += static_cast<float>(i + 1);
            }
        CHECK(memory.download() == expected);
    }
}

TEST_CASE("a pair of halves of which one is zero is flushed") {
    backend::memory<__half2> memory(std::vector<__half2>(size, __floats2half2_rn(0, 0)));
    backend::launch(halves{memory.data()});
    const std::vector<__half2> sums = memory.download();
    CHECK(__low2float(sums[1]) == 32);
    CHECK(__high2float(sums[1]) == 0);
    CHECK(__low2float(sums[2]) == 0);
    CHECK(__high2float(sums[2]) == 32);
}

TEST_SUITE_END();
