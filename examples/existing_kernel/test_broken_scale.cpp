// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <warpagg/emulate_cuda.hpp>

#include "broken_scale.cu"
WARPAGG_DYNAMIC_SHARED(float, sums);

namespace emulator = warpagg::emulator;

int main() {
    const emulator::device_array<float> values{1, 2, 3, 4, 5, 6, 7};
    emulator::device_array<float> scaled(7);
    const emulator::report r = emulator::try_launch(
        scale, {.blocks = 2, .threads = 4, .shared_bytes = 4 * sizeof(float)}, values, 7, scaled);
    std::printf("%s", r.text().c_str());
    return r.what == emulator::diagnosis::out_of_bounds ? 0 : 1;
}
