// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <vector>

#include "../../core/file_bytes.hpp"

namespace gs {

/// The attributes of an SPZ file, in the order of the file.
enum class spz_attribute : std::size_t { position, alpha, color, scale, rotation, sh };
inline constexpr std::size_t spz_attributes = 6;

/// The content of an SPZ file, without its compression.
struct spz_content {
    int version = 4;
    std::size_t count = 0;
    int sh_degree = 0;        ///< 0 to 4
    int fractional_bits = 0;  ///< of positions
    bool antialiased = false;
    std::array<std::vector<std::uint8_t>, spz_attributes> streams{};

    std::vector<std::uint8_t>& operator[](spz_attribute a) { return streams[static_cast<std::size_t>(a)]; }
    /// Returns the bytes per Gaussian of an attribute.
    std::size_t width(spz_attribute a) const;
};

/// Compresses and writes version 3 or 4. Version 4 uses all threads of the machine.
void write_spz_container(std::ostream& out, const spz_content& content);

/// Reads and decompresses versions 2 to 4. Checks sizes before it allocates memory. Throws `error`
/// with the file and the field.
spz_content read_spz_container(opened_file& file);

}  // namespace gs
