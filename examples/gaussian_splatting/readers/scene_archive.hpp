// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace gs {

/// How much an archive may contain. A larger one would rather exhaust the disk than be a scene.
struct archive_limits {
    std::uint64_t entries = 100'000;
    std::uint64_t bytes = std::uint64_t{64} << 30;  ///< of all unpacked files
    /// Unpacked files may also have at most this many bytes for each byte of the archive, apart
    /// from the first `always_allowed`. Photos hardly shrink in an archive.
    std::uint64_t ratio = 100;
    std::uint64_t always_allowed = std::uint64_t{64} << 20;
};

/// Returns whether the data of a scene is a `.zip` file.
bool is_archive(const std::string& data);

/// A temporary folder with the files of a `.zip` archive that scenes consist of. The destructor
/// removes it.
class extracted_archive {
  public:
    /// Unpacks images and the files of cameras and points. Skips all other files, those of macOS,
    /// and hidden ones. Throws `error` with the archive, and the entry, if the archive is malformed
    /// or encrypted, exceeds the limits, or has a symbolic link or an entry outside of the folder.
    /// Nothing stays on the disk then.
    explicit extracted_archive(const std::filesystem::path& archive, const archive_limits& limits = {});
    ~extracted_archive();
    extracted_archive(const extracted_archive&) = delete;
    extracted_archive& operator=(const extracted_archive&) = delete;

    const std::filesystem::path& folder() const { return folder_; }
    /// Returns the folder that is the only entry of `folder()`, or `folder()` if it has others.
    std::filesystem::path only_folder() const;
    /// Returns a message with the path of the archive in place of the temporary folder.
    std::string with_archive_name(std::string message) const;

  private:
    void remove_folder() const;

    std::filesystem::path archive_, folder_;
};

}  // namespace gs
