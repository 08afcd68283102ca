// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "../writer.hpp"

namespace gs {

/// Writes a model in the `.splat` layout of antimatter15's viewer: 32 bytes per Gaussian, little
/// endian, without a header. A Gaussian has its position and standard deviations as three floats
/// each, then red, green, blue, alpha, and the rotation w x y z as one byte each. View-dependent
/// color, a learned background and antialiasing are lost. Gaussians are sorted by opacity times
/// volume, the largest first, so that a viewer can draw the beginning of a file. Throws `error`
/// with the file and the Gaussian if a value is not finite, or a rotation is zero.
void write_splat(const std::filesystem::path& file, const gaussians& model,
                 const write_options& options = {});

/// Reads the files of `write_splat` and of other programs, as a model of SH degree 0. A byte of 0
/// or 255 becomes an opacity half a step inside, because 0 and 1 have no logit. Throws `error` with
/// the file and the Gaussian for: a size that is not a multiple of 32, a value that is not finite,
/// a negative scale, a rotation of zero.
gaussians read_splat(const std::filesystem::path& file);

/// The writer of files with the ending .splat. It uses both functions.
extern const writer splat_writer;

}  // namespace gs
