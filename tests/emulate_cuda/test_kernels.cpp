// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Kernels as their papers describe them: none is diagnosed, and their results are those of serial code.

#include "../support/for_each_seed.hpp"
#include "blend_backward.cu"
#include "hash_grid_backward.cu"
#include "scenes.hpp"
#include "sum_positive.cu"

TEST_CASE("the backward pass of alpha blending") {
    const blend_scene small(20), two_batches(300);
    for_each_seed(20, [&](std::uint64_t seed) { CHECK(small.run(blend_backward, seed).text() == ""); });
    for_each_seed(1, [&](std::uint64_t seed) { CHECK(two_batches.run(blend_backward, seed).text() == ""); });
}

TEST_CASE("the backward pass of a hash grid") {
    const hash_grid_scene scene;
    for_each_seed(20, [&](std::uint64_t seed) { CHECK(scene.run(hash_grid_backward, seed).text() == ""); });
}

TEST_CASE("a reduction with cooperative groups") {
    const sum_scene scene;
    for_each_seed(200, [&](std::uint64_t seed) { CHECK(scene.run(sum_positive, seed).text() == ""); });
}
