// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "convolve.hpp"

#include <cstring>
#include <warpagg/warp/simd_value.hpp>

#if !defined(WARPAGG_CONVOLVE)
#define WARPAGG_CONVOLVE convolve_as_built
#endif

namespace {

using part = gs::evaluate::convolution_part;
using values = warpagg::simd_value<float, part::channels>;

/// Copies each chunk of 256 bits on its own, which compilers do with one instruction.
/// @{
values load(const float* from) {
    values result;
    WARPAGG_UNROLL
    for (int i = 0; i < values::chunks; ++i)
        std::memcpy(&result.part[i], from + i * values::width, sizeof result.part[i]);
    return result;
}
void store(float* to, const values& from) {
    WARPAGG_UNROLL
    for (int i = 0; i < values::chunks; ++i)
        std::memcpy(to + i * values::width, &from.part[i], sizeof from.part[i]);
}
/// @}

/// Computes one tile, whose first pixel is `input` and `output`.
void convolve_tile(const part& p, const float* input, float* output) {
    // Loops over pixels are unrolled, so that the results stay in registers.
    values results[part::tile];
    WARPAGG_UNROLL
    for (std::size_t pixel = 0; pixel < part::tile; ++pixel) results[pixel] = load(p.bias);
    const float* weights = p.weights;
    for (std::ptrdiff_t row = -1; row <= 1; ++row) {
        // The values of three neighboring pixels are consecutive.
        const float* const from = input + (row * p.pitch - 1) * static_cast<std::ptrdiff_t>(p.depth);
        for (std::size_t i = 0; i < 3 * p.depth; ++i, weights += part::channels) {
            const values weight = load(weights);
            WARPAGG_UNROLL
            for (std::size_t pixel = 0; pixel < part::tile; ++pixel)
                results[pixel] = fma(values(from[pixel * p.depth + i]), weight, results[pixel]);
        }
    }
    WARPAGG_UNROLL
    for (std::size_t pixel = 0; pixel < part::tile; ++pixel)
        store(output + pixel * p.output_depth, max(results[pixel], values(0.0F)));
}

}  // namespace

void WARPAGG_CONVOLVE(const part& p) {
    for (std::size_t first = 0; first < p.pixels; first += part::tile)
        convolve_tile(p, p.input + first * p.depth, p.output + first * p.output_depth);
}
