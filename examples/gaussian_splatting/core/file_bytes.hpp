// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "error.hpp"

namespace gs {

/// A file that is open for reading, with its size in bytes. The constructor throws `error` with the
/// file's name if the file cannot be read.
struct opened_file {
    explicit opened_file(const std::filesystem::path& file) : name(file.string()) {
        std::error_code failed;
        size = std::filesystem::file_size(file, failed);
        if (failed) throw error("cannot read " + name + ": " + failed.message());
        in.open(file, std::ios::binary);
        if (!in) throw error("cannot read " + name);
    }

    std::string name;  ///< the path, for messages
    std::uint64_t size = 0;
    std::ifstream in;
};

/// Returns the content of a file. Throws `error` with the file's name if it cannot be read.
inline std::string file_bytes(const std::filesystem::path& file) {
    opened_file opened(file);
    std::string bytes(opened.size, '\0');
    opened.in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!opened.in) throw error("cannot read " + opened.name);
    return bytes;
}

}  // namespace gs
