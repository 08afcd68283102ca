// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>
#include <warpagg/emulate_cuda.hpp>

#include "after.cu"
#include "before.cu"

namespace emulator = warpagg::emulator;
using emulator::device_array;

constexpr int lamps = 3, width = 20, height = 10;

/// Returns the gradients that a kernel adds to its four arrays.
template <class Kernel>
std::vector<float> gradients(Kernel kernel, std::uint64_t seed) {
    const device_array<float2> centers{{3, 4}, {15, 2}, {9, 30}};  // the last lamp lights no pixel
    const device_array<float> radii{6, 9, 5}, powers{1, 0.5f, 2};
    const device_array<float3> colors{{1, 0.5f, 0.25f}, {0.5f, 1, 0.5f}, {1, 1, 1}};
    const device_array<float3> dL_dpixels(width * height, float3{0.5f, -0.25f, 1});
    device_array<float> dL_dcolors(3 * lamps, 0.0f), dL_dradii(lamps, 0.0f), dL_dpowers(lamps, 0.0f);
    device_array<float2> dL_dcenters(lamps, float2{0, 0});
    emulator::launch(kernel, {.blocks = {2, 2}, .threads = {16, 8}, .seed = seed}, centers, radii, powers,
                     colors, lamps, dL_dpixels, width, height, dL_dcolors, dL_dcenters, dL_dradii,
                     dL_dpowers);
    std::vector<float> all(dL_dcolors.begin(), dL_dcolors.end());
    for (int i = 0; i < lamps; ++i) {
        const float2 center = dL_dcenters[i];
        all.insert(all.end(), {center.x, center.y, dL_dradii[i], dL_dpowers[i]});
    }
    return all;
}

bool is_right(std::uint64_t seed) {
    const std::vector<float> before = gradients(lamp_gradients, seed);
    const std::vector<float> after = gradients(aggregated_lamp_gradients, seed);
    for (std::size_t i = 0; i < before.size(); ++i)
        if (std::abs(after[i] - before[i]) > 1e-3f) return false;
    return before[0] > 1 && before[6] == 0;  // lamp 0 lights pixels, and lamp 2 does not
}

int main() {
    if (!emulator::for_each_seed(20, is_right)) return 1;
    std::puts("port: passed");
}
