// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace gs::evaluate {

/// The part of a convolution that `convolve` computes: some channels of a range of pixels. The
/// values of a pixel's channels are consecutive in memory.
struct convolution_part {
    static constexpr int channels = 16;  ///< number of output channels
    static constexpr int tile = 6;       ///< number of pixels that are computed at a time

    const float* input;        ///< the first pixel of the range
    std::ptrdiff_t pitch;      ///< number of pixels from one row to the next
    std::size_t depth;         ///< number of input channels
    const float* weights;      ///< for each tap, row by row, and each input channel: `channels` values
    const float* bias;         ///< one value per output channel of the part
    float* output;             ///< the first pixel of the range, at the part's first channel
    std::size_t output_depth;  ///< number of channels in the output's memory
    std::size_t pixels;        ///< length of the range
};

}  // namespace gs::evaluate

extern "C" {
/// Convolves with a kernel of 3x3 pixels, adds the bias, and sets negative results to zero. Rounds
/// the number of pixels up to a multiple of `tile`. Precondition: the input exists for all
/// neighbors of these pixels.
///
/// Both functions are compiled from convolve.cpp, for different instruction sets.
/// @{
void convolve_x86_64_v3(const gs::evaluate::convolution_part& part);
void convolve_as_built(const gs::evaluate::convolution_part& part);
/// @}
}
