// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../writer.hpp"

namespace gs {

/// The SPZ files of Niantic: all parameters quantized, attribute by attribute, and compressed.
/// Version 4 compresses each attribute with zstd, version 3 the whole file with gzip. Both have:
///
/// | parameter | precision |
/// | --- | --- |
/// | position | 24 bits, fixed point; the fraction has 12 bits, if the size of the model allows |
/// | log of scale | 8 bits from -10 to 5.9375 |
/// | color | 8 bits; SH coefficients of degree 0 from -3.3 to 3.3 |
/// | opacity | 8 bits |
/// | rotation | the smallest three components with 10 bits each |
/// | view-dependent color | 7 bits from -1 to 1 |
///
/// The axes are x right, y up, z backward; both functions turn the model about its x axis. The flag
/// for antialiasing is kept, a learned background is lost. The order of the Gaussians stays.
///
/// Reading accepts versions 2 to 4. It ignores extensions, and SH coefficients of degree 4. It throws
/// `error` with the file and the field for: another version, sizes that contradict the number of
/// Gaussians, data that cannot be decompressed, content of more than 1000 times the size of the file.
extern const writer spz_writer;

}  // namespace gs
