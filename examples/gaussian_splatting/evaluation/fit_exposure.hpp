// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "../image/image.hpp"

namespace gs::evaluate {

/// The PSNR in dB of a picture's right half, after the affine map of its colours that brings its left half
/// nearest to the photo's, by least squares: what a photo's exposure was is not for a model to know, and no
/// pixel is measured by which it was found (the protocol of Martin-Brualla et al. 2021, NeRF in the Wild).
/// The picture is three planes of values, clamped to [0, 1] before and after; what a mask leaves out of the
/// photo does not count. Nothing where that is all of the right half.
std::optional<double> psnr_after_fit(const std::vector<float>& picture, const image& photo,
                                     const std::array<float, 3>& background);

}  // namespace gs::evaluate
