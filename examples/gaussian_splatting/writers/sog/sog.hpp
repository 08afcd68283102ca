// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../writer.hpp"

namespace gs {

/// Bundled SOG files of version 2 (PlayCanvas): a .zip archive without compression of `meta.json` and
/// lossless WebP images, whose pixels are Gaussians along a Morton curve.
///
/// | parameter | precision |
/// | --- | --- |
/// | position | 16 bits of the range of sign(x) log(1 + abs(x)) |
/// | log of scale, color | 256 numbers that fit the model |
/// | opacity | 8 bits |
/// | rotation | the smallest three components with 8 bits each |
/// | view-dependent color | a palette of at most 65536 entries, best for large, opaque Gaussians |
///
/// The axes are those of the model. Antialiasing is kept as `antialias` and `model`, a learned
/// background is lost.
///
/// Reading throws `error` with the file and the field for: an archive or an image that is damaged, a
/// missing image, an image that is too small, a number that is not finite, an index beyond the palette,
/// more than 10 Gaussians for each byte of the file.
extern const writer sog_writer;

}  // namespace gs
