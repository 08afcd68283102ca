// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "../model/gaussians.hpp"

namespace gs {

/// Returns the lines of a PLY header that describe a model beyond its Gaussians:
/// `SplatRenderMode: mip`, which Brush also writes, for antialiased Gaussians, and `SkyHarmonics:`
/// with the coefficients of a learned background.
std::string ply_comments(const gaussians& model);

/// Sets `antialiased` or `sky` if the line is one of `ply_comments`. Throws `error` with the file
/// for a malformed sky.
void read_ply_comment(std::string_view line, const std::string& file, gaussians& model);

/// Throws `error` with the file if the learned background cannot be written.
void require_finite_sky(const std::filesystem::path& file, const gaussians& model);

}  // namespace gs
