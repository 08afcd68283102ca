// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace gs::train {

/// The difference between renders and their targets: means over pixels and color channels.
struct image_quality {
    double absolute_error = 0;
    double square_error = 0;
    double ssim = 0;  ///< structural similarity (Wang et al. 2004)

    /// Returns the PSNR in decibels, for images with values in [0, 1].
    double psnr() const { return -10 * std::log10(square_error); }
};

}  // namespace gs::train
