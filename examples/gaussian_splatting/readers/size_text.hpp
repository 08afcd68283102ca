// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace gs {

/// Returns a size for messages: "40x30".
inline std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

/// Returns a number of things for messages: "1 photo", "2 photos".
inline std::string count_text(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace gs
