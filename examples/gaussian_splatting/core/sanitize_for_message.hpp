// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gs {

/// Makes text from a file safe for messages. Cuts the text after 255 bytes and replaces control
/// characters, which could end the line or control a terminal, with question marks.
inline std::string sanitize_for_message(std::string_view text) {
    constexpr std::size_t longest = 255;
    std::string shown(text.substr(0, longest));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
    return text.size() > longest ? shown + " ..." : shown;
}

}  // namespace gs
