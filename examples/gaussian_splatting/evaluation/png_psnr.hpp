// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../image/image.hpp"

namespace gs::evaluate {

/// Returns the PSNR in dB that other tools compute from the files of `write_png`, in which both
/// images are rounded to 8 bits. `render` and `target` have three planes each, of the size of
/// `photo`. Pixels that `photo` masks do not count; the result is NaN if it masks all of them.
double png_psnr(const std::vector<float>& render, const std::vector<float>& target, const image& photo);

}  // namespace gs::evaluate
