// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace gs::evaluate {

/// The PSNR in dB of a picture's right half, after the affine map of its colours that brings its left half
/// nearest to the photo's, by least squares: what a photo's exposure was is not for a model to know, and no
/// pixel is measured by which it was found (the protocol of Martin-Brualla et al. 2021, NeRF in the Wild).
/// Both are three planes of values; the picture is clamped to [0, 1] before and after.
double psnr_after_fit(const std::vector<float>& picture, const std::vector<float>& photo, int width,
                      int height);

}  // namespace gs::evaluate
