// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "error.hpp"

namespace gs {

/// Writes a file through `fill`, aside under another name, and renames it when it is whole: a reader sees the
/// old file or the new one. Throws `error` naming the file when it cannot be written.
inline void write_aside(const std::filesystem::path& file, const std::function<void(std::ostream&)>& fill) {
    const std::filesystem::path aside = file.string() + ".part";
    std::error_code ignored;
    try {
        std::ofstream out(aside, std::ios::binary);
        if (out) fill(out);
        out.close();
        if (!out) throw error("cannot write " + file.string());
    } catch (...) {
        std::filesystem::remove(aside, ignored);
        throw;
    }
    std::error_code failed;
    std::filesystem::rename(aside, file, failed);
    if (failed) {
        std::filesystem::remove(aside, ignored);
        throw error("cannot write " + file.string() + ": " + failed.message());
    }
}

}  // namespace gs
