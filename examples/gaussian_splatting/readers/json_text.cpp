// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "json_text.hpp"

#include <algorithm>
#include <string_view>

#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "validation.hpp"

namespace gs {
namespace {

/// Returns whether a number begins here. In JSON, one of the characters in `before` precedes a
/// number. At any other character the lexer stops.
bool begins_number(const std::string& text, std::size_t at) {
    constexpr std::string_view first = "-0123456789", before = " \t\r\n,:[";
    return first.find(text[at]) != std::string_view::npos && at > 0 &&
           before.find(text[at - 1]) != std::string_view::npos;
}

}  // namespace

std::string json_text(const std::filesystem::path& file) {
    constexpr std::string_view no_numbers[] = {"NaN", "-Infinity", "Infinity"};
    std::string text = file_bytes(file);
    bool quoted = false;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!quoted)
            for (const std::string_view word : no_numbers)
                if (text.compare(i, word.size(), word) == 0)
                    text.replace(i, word.size(), "{}" + std::string(word.size() - 2, ' '));
        if (!quoted && (text[i] == '"' || begins_number(text, i))) kept = 0;
        kept += static_cast<unsigned char>(text[i]) < ' ' ? 8 : 1;
        if (kept > longest_path)
            throw error(file.string() + " holds a string or number, or a gap between two, that is too long" +
                        line_and_byte(text, i + 1));
        if (text[i] == '"') quoted = !quoted;
        if (quoted && text[i] == '\\') {  // an escaped quote does not end the string
            ++i;
            ++kept;
        }
    }
    return text;
}

std::string line_and_byte(const std::string& text, std::size_t byte) {
    const auto before = static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    const auto line = 1 + std::count(text.begin(), text.begin() + before, '\n');
    return ": line " + std::to_string(line) + ", byte " + std::to_string(byte);
}

}  // namespace gs
