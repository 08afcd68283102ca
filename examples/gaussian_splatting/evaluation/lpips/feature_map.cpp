// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "feature_map.hpp"

#include <algorithm>
#include <utility>

#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "convolve.hpp"

namespace gs::evaluate {

namespace {

using convolve_function = void (*)(const convolution_part&);

convolve_function choose_convolve() {
#if defined(WARPAGG_CPU_LEVELS)
    if (!__builtin_cpu_supports("x86-64-v3"))
        throw error(
            "LPIPS is compiled for AVX2, which this CPU does not have: build with -DWARPAGG_CPU_LEVELS=OFF "
            "-DWARPAGG_CPU_ARCH=native");
    return convolve_x86_64_v3;
#else
    return convolve_as_built;
#endif
}

/// Returns the weights in the order of `convolution_part`.
std::vector<float> reordered(std::size_t depth, std::size_t output_depth, const std::vector<float>& weights) {
    constexpr std::size_t taps = 9, channels = convolution_part::channels;
    std::vector<float> result(weights.size());
    for (std::size_t to = 0; to < output_depth; ++to)
        for (std::size_t from = 0; from < depth; ++from)
            for (std::size_t tap = 0; tap < taps; ++tap)
                result[((to / channels * taps + tap) * depth + from) * channels + to % channels] =
                    weights[(to * depth + from) * taps + tap];
    return result;
}

}  // namespace

feature_map::feature_map(std::size_t width, std::size_t height, std::size_t depth)
    : width_(width),
      height_(height),
      depth_(depth),
      values_(std::make_unique_for_overwrite<float[]>(size())) {}

/// Includes pixels after the frame, because `convolve` rounds the number of pixels up.
std::size_t feature_map::size() const {
    return ((height_ + 2) * pitch() + 1 + convolution_part::tile) * depth_;
}

void feature_map::clear_frame() {
    float* const end = values_.get() + size();
    std::fill(values_.get(), at(0, 0), 0.0F);
    for (std::size_t row = 0; row < height_; ++row) std::fill(at(width_, row), at(width_ + 1, row), 0.0F);
    std::fill(at(0, height_), end, 0.0F);
}

convolution::convolution(std::size_t depth, std::size_t output_depth, const std::vector<float>& weights,
                         std::vector<float> bias)
    : depth_(depth),
      output_depth_(output_depth),
      weights_(reordered(depth, output_depth, weights)),
      bias_(std::move(bias)) {}

feature_map convolution::operator()(const feature_map& input) const {
    static const convolve_function convolve = choose_convolve();
    constexpr std::size_t channels = convolution_part::channels;
    constexpr std::size_t band = 256 * convolution_part::tile;  // pixels per call
    feature_map output(input.width(), input.height(), output_depth_);
    // The range from the first to the last pixel includes the frame between rows, which is cleared.
    const std::size_t pixels = input.height() * input.pitch(), bands = (pixels + band - 1) / band;
    const std::size_t weights_per_part = weights_.size() / (output_depth_ / channels);
    for_each_in_parallel(output_depth_ / channels * bands, [&](std::size_t task) {
        const std::size_t part = task / bands, first = task % bands * band;
        convolve({.input = input.at(0, 0) + first * depth_,
                  .pitch = static_cast<std::ptrdiff_t>(input.pitch()),
                  .depth = depth_,
                  .weights = &weights_[part * weights_per_part],
                  .bias = &bias_[part * channels],
                  .output = output.at(0, 0) + first * output_depth_ + part * channels,
                  .output_depth = output_depth_,
                  .pixels = std::min(band, pixels - first)});
    });
    output.clear_frame();
    return output;
}

feature_map max_pool(const feature_map& input) {
    feature_map output(input.width() / 2, input.height() / 2, input.depth());
    for_each_in_parallel(output.height(), [&](std::size_t row) {
        for (std::size_t column = 0; column < output.width(); ++column) {
            const float *const above = input.at(2 * column, 2 * row), *const right = above + input.depth();
            const float *const below = input.at(2 * column, 2 * row + 1), *const diagonal =
                                                                              below + input.depth();
            float* const to = output.at(column, row);
            for (std::size_t i = 0; i < input.depth(); ++i)
                to[i] = std::max(std::max(above[i], right[i]), std::max(below[i], diagonal[i]));
        }
    });
    output.clear_frame();
    return output;
}

}  // namespace gs::evaluate
