// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace gs {

/// Joins words for a sentence: returns "a, b or c" if `last_separator` is " or ".
std::string enumerated(const auto& words, const char* last_separator) {
    std::string text;
    std::size_t i = 0;
    for (const auto& word : words) {
        text += i == 0 ? "" : i + 1 < words.size() ? ", " : last_separator;
        text += word;
        ++i;
    }
    return text;
}

}  // namespace gs
