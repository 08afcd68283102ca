// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace gs {

/// Writes JSON to a file, and replaces invalid UTF-8, such as in names of photos. Throws `error` if the file
/// cannot be written: see `atomic_file_write`.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace gs
