// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "../writer.hpp"

namespace gs {

/// Writes a model in the layout of the reference implementation (Kerbl et al. 2023), which viewers
/// read: binary little endian, properties x y z nx ny nz f_dc_0..2 f_rest_* (channel-major) opacity
/// scale_0..2 rot_0..3, all float. The comment `SplatRenderMode: mip`, which Brush also writes,
/// marks antialiased Gaussians. The comment `SkyHarmonics:` holds the coefficients of a learned
/// background. Replaces the file as a whole. Throws `error` with the file, and with the property if
/// a value is not finite; the old file then stays.
void write_ply(const std::filesystem::path& file, const gaussians& model, const write_options& options = {});

/// Reads the files of `write_ply` and of other trainers. Properties may have any order and any
/// scalar type; unknown ones are skipped, and normals are optional. The number of f_rest properties
/// gives the SH degree, 0 to 3. Elements other than `vertex` must be empty.
///
/// Throws `error` with the file and the field for: a file that is not PLY, ASCII or big-endian
/// data, a header beyond 64 KiB, a missing property, a count that contradicts the size of the file,
/// a value that is not finite. Allocates at most four times the size of the file plus 64 KiB per
/// thread, also for malformed files.
gaussians read_ply(const std::filesystem::path& file);

/// The writer of files with the ending .ply. It uses both functions.
extern const writer ply_writer;

}  // namespace gs
