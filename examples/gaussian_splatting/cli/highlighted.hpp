// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

namespace gs::cli {

enum class message_color { red, yellow };

/// Returns the text in bold color if `stream` is a terminal and the environment variable NO_COLOR is
/// unset or empty (see no-color.org). Otherwise returns the text.
std::string highlighted(const std::string& text, message_color color, std::FILE* stream);

}  // namespace gs::cli
