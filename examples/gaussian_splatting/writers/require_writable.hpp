// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "../model/gaussians.hpp"

namespace gs {

/// Throws `error` with the file and the Gaussian if a value up to `sh_degree` is not finite, or a
/// rotation is zero.
void require_writable(const std::filesystem::path& file, const gaussians& model, int sh_degree);

/// Returns an empty model with memory for `count` Gaussians of an SH degree.
gaussians sized_model(std::size_t count, int sh_degree);

}  // namespace gs
