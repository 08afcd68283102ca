// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../image.hpp"

namespace gs {

inline constexpr std::uint64_t largest_side = 65536;  ///< in pixels

struct image_size {
    std::uint64_t width = 0, height = 0;
    bool operator==(const image_size&) const = default;
};

/// An image file that is open for reading.
class image_file {
  public:
    /// Throws `error` if the file is missing or not a regular file.
    explicit image_file(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }

    /// Returns the stream, at the beginning of the file.
    std::FILE* rewound() const;

    std::uint64_t size_in_bytes() const;

    /// Returns the content, or its first `most` bytes.
    std::vector<std::uint8_t> bytes(std::size_t most = std::numeric_limits<std::size_t>::max()) const;

    /// Throws `error` with the file and the reason why it cannot be read.
    [[noreturn]] void refuse(const std::string& why) const;

    /// Throws `error` if the size is zero or exceeds the limits of `read_image`.
    void check_size(const image_size& size) const;

    /// Refuses a header that promises a huge image although the file is tiny. Call it before memory
    /// is allocated.
    void check_density(const image_size& size) const;

    /// Throws `error` if a decoder finds another size than the header promised.
    void check_decoded_size(const image_size& found, const image_size& promised) const;

  private:
    struct closer {
        void operator()(std::FILE* stream) const { std::fclose(stream); }
    };

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, closer> stream_;
};

image_size size_of(const image& pixels);

/// Multiplies colors by alpha and sets `has_alpha`.
void premultiply(image& pixels);

}  // namespace gs
