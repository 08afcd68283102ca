// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace gs::train {

/// What pictures were found to be worth beside their photos: means over pixels and channels.
struct quality {
    double absolute = 0;  ///< error
    double square = 0;    ///< error
    double ssim = 0;      ///< structural similarity

    double psnr() const { return -10 * std::log10(square); }
    double loss(double ssim_weight) const { return (1 - ssim_weight) * absolute + ssim_weight * (1 - ssim); }
};

}  // namespace gs::train
