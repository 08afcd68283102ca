// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../writer.hpp"

namespace gs {

/// The functions of `sog_writer`, which describes them.
/// @{
void write_sog(const std::filesystem::path& file, const gaussians& model, const write_options& options);
gaussians read_sog(const std::filesystem::path& file);
/// @}

}  // namespace gs
