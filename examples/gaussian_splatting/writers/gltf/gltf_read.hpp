// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "../../model/gaussians.hpp"

namespace gs {

/// The function `read` of `gltf_writer`, which describes it.
gaussians read_gltf(const std::filesystem::path& file);

}  // namespace gs
