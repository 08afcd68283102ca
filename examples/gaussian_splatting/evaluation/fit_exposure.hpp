// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "../image/image.hpp"

namespace gs::evaluate {

/// Returns the PSNR in dB of a render whose exposure is unknown. Fits an affine map of colors to
/// the left half of the photo by least squares, and measures the right half with this map. So no
/// pixel serves for both purposes. Source: the protocol of Martin-Brualla et al. 2021 (NeRF in the
/// Wild).
///
/// `render` has three planes of values, which are clamped to [0, 1] before and after the map.
/// Masked pixels do not count. Returns nothing if the right half is masked entirely.
std::optional<double> psnr_after_fit(const std::vector<float>& render, const image& photo,
                                     const std::array<float, 3>& background);

/// Returns the PSNR in dB of the right half of a render, like `psnr_after_fit` without the fit.
std::optional<double> psnr_of_right_half(const std::vector<float>& render, const image& photo,
                                         const std::array<float, 3>& background);

}  // namespace gs::evaluate
