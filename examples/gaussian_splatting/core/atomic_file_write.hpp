// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "error.hpp"

namespace gs {

/// Replaces a file with the output of `fill`. `fill` writes to a temporary file in the same folder,
/// which is then renamed, so that other programs see either the old file or the complete new one.
/// Throws `error` with the file's name if it cannot be written, and rethrows exceptions of `fill`.
/// In both cases the old file stays.
inline void atomic_file_write(const std::filesystem::path& file,
                              const std::function<void(std::ostream&)>& fill) {
    const std::filesystem::path temporary = file.string() + ".part";
    std::error_code ignored;
    try {
        errno = 0;
        std::ofstream out(temporary, std::ios::binary);
        if (out) fill(out);
        out.close();
        if (!out)
            throw error("cannot write " + file.string() +
                        (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
    } catch (...) {
        std::filesystem::remove(temporary, ignored);
        throw;
    }
    std::error_code failed;
    std::filesystem::rename(temporary, file, failed);
    if (failed) {
        std::filesystem::remove(temporary, ignored);
        throw error("cannot write " + file.string() + ": " + failed.message());
    }
}

}  // namespace gs
