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
/// Replaces NaN and Infinity, which Python's json module writes although JSON lacks them, with
/// empty objects of the same length. Empty objects are not numbers, so the parser can name the
/// frame that contains one. Positions in the text stay the same.
///
/// The lexer keeps all text since the beginning of a string or number, and several copies of it if
/// it finds an error. Therefore this function throws `error` with file, line and byte if that text
/// has more than `longest_path` bytes. Control characters count eight times, because messages spell
/// them out. Throws `error` if the file cannot be read.
std::string json_text(const std::filesystem::path& file);

/// Returns ": line LINE, byte BYTE" for a message, both counted from 1.
std::string line_and_byte(const std::string& text, std::size_t byte);

}  // namespace gs
