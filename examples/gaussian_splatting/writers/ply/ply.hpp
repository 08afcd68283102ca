// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "../../model/gaussians.hpp"

namespace gs {

/// Writes the layout of the reference implementation, which viewers read: binary little endian, properties
/// x y z nx ny nz f_dc_0..2 f_rest_* (channel-major) opacity scale_0..2 rot_0..3, all float. That Gaussians
/// are antialiased is the comment `SplatRenderMode: mip`, as Brush writes it; a sky is the comment
/// `SkyHarmonics:` with its numbers. Written aside and renamed.
/// Throws `error` naming the file; also where a value is not finite: what was there before stays.
void write_ply(const std::filesystem::path& file, const gaussians& model);

/// Reads what `write_ply` and other trainers write: properties in any order, further scalar properties of any
/// PLY type skipped, normals optional, SH degree 0 to 3 by the number of f_rest properties, elements other
/// than `vertex` only where they are empty. Throws `error` naming the file and the field: no PLY, ascii or
/// big endian, a header beyond 64 KiB, a missing field, a count that the file's size contradicts, a value
/// that is not finite. What it allocates, at any time, is below four times the file's size and 64 KiB,
/// whatever the header says.
gaussians read_ply(const std::filesystem::path& file);

}  // namespace gs
