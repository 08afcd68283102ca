// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <warpagg/emulate_cuda.hpp>

#include "scale.cu"
WARPAGG_DYNAMIC_SHARED(float, sums);  // for the array that the kernel declares as extern __shared__

namespace emulator = warpagg::emulator;

bool is_right(std::uint64_t seed) {
    const emulator::device_array<float> values{1, 2, 3, 4, 5, 6, 7};
    emulator::device_array<float> scaled(7);
    const emulator::cuda_grid grid{.blocks = 2, .threads = 4, .shared_bytes = 16, .seed = seed};
    emulator::launch(scale, grid, values, 7, scaled);
    return scaled[0] == 1 / 10.0f && scaled[3] == 4 / 10.0f && scaled[6] == 7 / 18.0f;
}

int main() {
    if (!emulator::for_each_seed(200, is_right)) return 1;
    std::puts("scale: passed");
}
