// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "highlighted.hpp"

#include <unistd.h>

#include <cstdlib>

namespace gs::cli {

std::string highlighted(const std::string& text, message_color color, std::FILE* stream) {
    const char* forbidden = std::getenv("NO_COLOR");
    if (isatty(fileno(stream)) == 0 || (forbidden != nullptr && *forbidden != '\0')) return text;
    return (color == message_color::red ? "\x1b[1;31m" : "\x1b[1;33m") + text + "\x1b[0m";
}

}  // namespace gs::cli
