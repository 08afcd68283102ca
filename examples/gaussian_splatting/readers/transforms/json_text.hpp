// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace gs {

/// Reads a JSON file as text that nlohmann's lexer can parse within bounded memory. The text has
/// the length of the file.
///
/// Replaces NaN and Infinity, which Python's json module writes although JSON lacks them, by empty
/// objects of the same length. They are not numbers, so the parser can name the frame that contains
/// one, and positions stay the same.
///
/// The lexer keeps all text since the beginning of a string or number, several times over if it
/// finds an error. Therefore throws `error` with file, line and byte if that is more than
/// `longest_path` bytes, where control characters count eight times because messages spell them
/// out. Throws `error` if the file cannot be read.
std::string json_text(const std::filesystem::path& file);

/// ": line LINE, byte BYTE", both counted from 1, for a message.
std::string line_and_byte(const std::string& text, std::size_t byte);

}  // namespace gs
