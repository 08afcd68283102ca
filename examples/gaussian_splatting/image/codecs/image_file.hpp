// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "../image.hpp"

namespace gs {

inline constexpr std::uint64_t largest_side = 65536;  ///< in pixels

/// Throws `error` with the file and the reason why it cannot be read.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

struct file_closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using open_file = std::unique_ptr<std::FILE, file_closer>;

/// Opens a file for reading. Throws `error` if it is missing or not a regular file.
open_file open_to_read(const std::filesystem::path& file);

/// Throws `error` if the size is zero or exceeds the limits of `read_image`.
void check_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height);

/// Refuses a header that promises a huge image although the file is tiny. Call it before memory is
/// allocated.
void check_density(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height);

image blank_image(int width, int height);

/// Multiplies colors by alpha and sets `has_alpha`.
void premultiply(image& pixels);

/// The format according to the first bytes of a file. For a PNG also the size, which has a fixed
/// position.
struct first_bytes {
    bool is_png = false;
    std::uint64_t png_width = 0, png_height = 0;
};

first_bytes look_at(const std::filesystem::path& file, std::FILE* opened);

image read_png(const std::filesystem::path& file, std::FILE* opened, int width, int height);
image read_jpeg(const std::filesystem::path& file, std::FILE* opened);
void read_jpeg_size(const std::filesystem::path& file, std::FILE* opened, int& width, int& height);

}  // namespace gs
