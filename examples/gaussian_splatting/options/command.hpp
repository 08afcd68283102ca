// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace gs::options {

/// The commands of the program.
enum class command { train, evaluate, render, convert, compare, view, inspect, doctor };

constexpr std::array<std::string_view, 8> names_of(command) {
    return {"train", "evaluate", "render", "convert", "compare", "view", "inspect", "doctor"};
}

}  // namespace gs::options
