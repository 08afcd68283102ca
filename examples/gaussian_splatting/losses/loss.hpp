// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The interface of an image loss, a measure of the difference between a render and its target that
/// training minimizes. To add a loss, implement `loss` in a new folder, with the device as a
/// template parameter, and add it to the list in losses.hpp.

#include <cmath>
#include <limits>
#include <span>

#include "../metrics/target_image.hpp"
#include "../render/geometry/list_capacity.hpp"

namespace gs::train {

/// The loss that training minimizes by default: see the list in losses.hpp.
inline constexpr const char* default_loss = "l1_ssim";

/// Means over the renders of several steps.
struct loss_report {
    double loss = 0;
    double square_error = 0;  ///< mean over pixels and color channels

    /// Returns the PSNR in decibels, for images with values in [0, 1].
    double psnr() const { return -10 * std::log10(square_error); }
};

/// A loss on a device. `Real` is float in training, and double in tests that compare the gradient
/// with finite differences.
///
/// All pointers are to device memory. A GPU captures the launches of a step as a graph, so
/// `set_target` and `gradient` must not wait for the device, and may allocate only when the size of
/// the target is new.
template <class Real>
class loss {
  public:
    virtual ~loss() = default;

    /// Sets the target of the next calls of `gradient`. Masked pixels must have a gradient of zero.
    virtual void set_target(const target_image& target) = 0;

    /// Returns the gradient of the loss with respect to each value of the render. Both have three
    /// planes, red, green and blue, of the target's size. The result is valid until the next call.
    /// Also adds the loss and the square error to `sums()`, unless `capacity.exceeded()`: the
    /// render is then incomplete, and the step is skipped.
    ///
    /// With several ranks, only the target's `compared_rows` of the result are used, and only they may
    /// be added to the sums. The render has these rows and `reach()` more on both sides; its other
    /// rows are undefined. Means are still over all pixels of the target.
    virtual const Real* gradient(const Real* render, const raster::list_capacity& capacity) = 0;

    /// Returns by how many rows a value of the render can be away from the values of the gradient that
    /// depend on it. The default is right for any loss; smaller numbers let ranks blend fewer rows.
    virtual int reach() const { return std::numeric_limits<int>::max(); }

    /// Returns the largest magnitude of one value of the gradient for the current target, up to a
    /// small factor: for a mean over n pixels of a function with slope s, about s / n. In
    /// deterministic training, fixed-point sums can hold `raster::gradient_sums::headroom` times
    /// this value. A scale that is much too large costs precision. If it is too small, values are
    /// out of range: they are not added, and training reports `fault_kind::sum`.
    virtual float gradient_scale() const = 0;

    /// Returns the running sums from which `take` computes its means. Training stops with an error
    /// if one of them is not finite. With several ranks, the engine adds those of all ranks before it
    /// calls `take`.
    virtual std::span<double> sums() const = 0;

    /// Returns the means over the renders since the last call, and sets the sums to zero. Waits for
    /// the device.
    virtual loss_report take() = 0;
};

}  // namespace gs::train
