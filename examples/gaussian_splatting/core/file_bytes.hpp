// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
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

/// A file whose parts several threads read at once. The constructor throws `error` with the file's
/// name if the file cannot be read.
class shared_file {
  public:
    explicit shared_file(const std::filesystem::path& file)
        : name_(file.string()), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
        if (descriptor_ < 0) throw error("cannot read " + name_);
    }
    shared_file(const shared_file&) = delete;
    shared_file& operator=(const shared_file&) = delete;
    ~shared_file() { ::close(descriptor_); }

    /// Reads `size` bytes from a position on. Throws `error` with the file's name if there are fewer.
    void read(std::uint64_t position, char* bytes, std::size_t size) const {
        while (size > 0) {
            const auto got = ::pread(descriptor_, bytes, size, static_cast<off_t>(position));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) throw error("cannot read " + name_);
            position += static_cast<std::uint64_t>(got);
            bytes += got;
            size -= static_cast<std::size_t>(got);
        }
    }

  private:
    std::string name_;
    int descriptor_;
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
