// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <ostream>

#include "../writer.hpp"

namespace gs {

/// The compressed PLY files of PlayCanvas: 16 bytes per Gaussian, and one byte per SH coefficient
/// above degree 0. Gaussians are sorted along a Morton curve. Each chunk of 256 has the ranges of
/// its positions, scales and colors, and stores them relative to these ranges:
///
/// | parameter | precision |
/// | --- | --- |
/// | position, log of scale | 11, 10 and 11 bits of the chunk's range; the log is from -20 to 20 |
/// | color | 8 bits of the chunk's range |
/// | opacity | 8 bits |
/// | rotation | the smallest three components with 10 bits each |
/// | view-dependent color | 8 bits from -4 to 4 |
///
/// The axes are those of the model. The header has the comments of `ply_comments`, so that
/// antialiasing and a learned background are kept.
///
/// Reading throws `error` with the file and the field for: a malformed header, a number of chunks or
/// of SH rows that contradicts the number of vertices, a count that contradicts the size of the
/// file, a range that is not finite. It allocates at most four times the size of the file, plus 64
/// KiB.
extern const writer compressed_ply_writer;

/// Writes the bytes of such a file to a stream, row by row. Throws `error` with the name `file` and
/// the Gaussian for values that are not finite, before it writes.
void write_compressed_ply(std::ostream& out, const std::filesystem::path& file, const gaussians& model,
                          const write_options& options);

}  // namespace gs
