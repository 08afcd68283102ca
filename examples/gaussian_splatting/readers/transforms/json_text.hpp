// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace gs {

/// The text of a JSON file as nlohmann's lexer takes it, within bounded memory; byte for byte as long as the
/// file.
///
/// Python's json writes NaN and Infinity, which JSON does not have. They become empty objects of the same
/// length: nowhere a number, so that who reads can name the frame that holds one, and no byte moves.
///
/// The lexer keeps, several times over where it finds an error, all that it has read since a string or a
/// number began. Throws `error` naming file, line and byte where that is more than `longest_path` bytes,
/// control characters, which its messages spell out, counted as eight; and `error` where the file cannot be
/// read.
std::string json_text(const std::filesystem::path& file);

/// ": line LINE, byte BYTE", both counted from 1, for a message.
std::string line_and_byte(const std::string& text, std::size_t byte);

}  // namespace gs
