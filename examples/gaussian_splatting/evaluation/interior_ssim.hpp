// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "../image/image.hpp"

namespace gs::evaluate {

/// Returns the mean SSIM (Wang et al. 2004) over the windows of 11x11 pixels that lie inside the
/// image and contain no masked pixel. scikit-image computes the same with the options
/// `gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1`, and so does
/// torchmetrics with its defaults and `data_range=1`.
///
/// `render` and `target` have three planes each, of the size of `photo`, with values in [0, 1].
/// Returns nothing if no window counts, such as for an image with fewer than 11 rows. Takes time
/// proportional to the number of pixels, on one thread.
std::optional<double> interior_ssim(const std::vector<float>& render, const std::vector<float>& target,
                                    const image& photo);

}  // namespace gs::evaluate
