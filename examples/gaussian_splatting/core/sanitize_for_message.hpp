// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gs {

/// A piece of a file as a message shows it: one that is longer than a name can be is cut, and what would end
/// the line or steer a terminal becomes a question mark.
inline std::string clipped(std::string_view text) {
    constexpr std::size_t longest = 255;
    std::string shown(text.substr(0, longest));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
    return text.size() > longest ? shown + " ..." : shown;
}

}  // namespace gs
