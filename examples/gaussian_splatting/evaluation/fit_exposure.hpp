// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "../image/image.hpp"

namespace gs::evaluate {

/// The PSNR in dB of a render whose exposure is unknown: an affine map of colors is fitted to the
/// left half of the photo by least squares, and the right half is measured with it, so that no
/// pixel serves for both (the protocol of Martin-Brualla et al. 2021, NeRF in the Wild). `render`
/// has three planes of values, which are clamped to [0, 1] before and after the map. Masked pixels
/// do not count. None if the right half is masked entirely.
std::optional<double> psnr_after_fit(const std::vector<float>& render, const image& photo,
                                     const std::array<float, 3>& background);

}  // namespace gs::evaluate
