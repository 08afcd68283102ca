// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "../error.hpp"

namespace gs {

/// A whole file. Throws `error` naming it where it cannot be read.
inline std::string file_bytes(const std::filesystem::path& file) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(file, failed);
    if (failed) throw error("cannot read " + file.string() + ": " + failed.message());
    std::string bytes(size, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!in) throw error("cannot read " + file.string());
    return bytes;
}

}  // namespace gs
