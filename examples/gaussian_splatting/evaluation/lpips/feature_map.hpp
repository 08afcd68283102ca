// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace gs::evaluate {

/// An image with any number of channels, surrounded by a frame of zeros that is one pixel wide. The
/// values of a pixel's channels are consecutive in memory. Rows share their frame: the zero to the
/// right of a row is the zero to the left of the next one.
class feature_map {
  public:
    /// Leaves the values uninitialized.
    feature_map(std::size_t width, std::size_t height, std::size_t depth);

    std::size_t width() const { return width_; }
    std::size_t height() const { return height_; }
    std::size_t depth() const { return depth_; }  ///< number of channels
    std::size_t pitch() const { return width_ + 1; }
    /// Returns the first channel of a pixel. Column `width()` and row `height()` are in the frame.
    float* at(std::size_t column, std::size_t row) { return values_.get() + index(column, row); }
    const float* at(std::size_t column, std::size_t row) const { return values_.get() + index(column, row); }
    /// Sets the frame to zero. Call this after writing the pixels.
    void clear_frame();

  private:
    std::size_t index(std::size_t column, std::size_t row) const {
        return ((row + 1) * pitch() + column + 1) * depth_;
    }
    std::size_t size() const;

    std::size_t width_, height_, depth_;
    std::unique_ptr<float[]> values_;
};

/// A convolution with 3x3 pixels and zero padding, followed by a rectifier (ReLU).
class convolution {
  public:
    /// `weights` has the order of PyTorch: output channel, input channel, row, column.
    /// Precondition: the number of output channels is a multiple of `convolution_part::channels`.
    convolution(std::size_t depth, std::size_t output_depth, const std::vector<float>& weights,
                std::vector<float> bias);

    /// Takes time proportional to pixels, input channels and output channels, on all threads.
    /// Throws `error` on an x86 processor without AVX2.
    feature_map operator()(const feature_map& input) const;

  private:
    std::size_t depth_, output_depth_;
    std::vector<float> weights_;  ///< one `convolution_part::weights` after another
    std::vector<float> bias_;
};

/// Returns the maxima of squares of 2x2 pixels. An odd last row or column is left out.
feature_map max_pool(const feature_map& input);

}  // namespace gs::evaluate
