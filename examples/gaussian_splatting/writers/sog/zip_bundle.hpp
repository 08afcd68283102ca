// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

struct zip;

namespace gs {

struct bundled_file {
    std::string name, bytes;
};

/// Returns a .zip archive of these files without compression. The same files make the same archive.
std::string zip_of(std::span<const bundled_file> files);

/// A .zip archive that is open for reading.
class zip_bundle {
  public:
    /// Throws `error` with the file's name if it is no archive.
    explicit zip_bundle(const std::filesystem::path& file);

    /// Returns the content of a file at the top of the archive. Throws `error` with both names if it
    /// does not exist, is damaged, or has more than `most` bytes.
    std::string read(const std::string& name, std::uint64_t most) const;

  private:
    std::string where_;
    std::shared_ptr<zip> archive_;
};

}  // namespace gs
