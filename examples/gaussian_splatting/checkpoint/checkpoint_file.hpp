// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "state_archive.hpp"

namespace gs {

/// Writes a checkpoint as a safetensors file. The metadata of the file hold the values of the
/// archive and a checksum (CRC-32). Replaces an existing file only when the new one is complete.
/// Throws `error` if the file cannot be written.
void write_checkpoint(const std::filesystem::path& file, const state_archive& archive);

/// Returns an archive that loads the state of a checkpoint. Throws `error` if the file cannot be
/// read, is damaged or is no checkpoint.
state_archive read_checkpoint(const std::filesystem::path& file);

}  // namespace gs
