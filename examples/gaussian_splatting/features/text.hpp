// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace gs::features {

/// Returns a line of evidence, formatted as printf does, of at most 239 characters.
template <class... Values>
std::string text(const char* format, Values... values) {
    char line[240];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

/// The smallest number of points from which a feature draws conclusions about a scene.
inline constexpr std::size_t enough_points = 50;

inline std::string too_few_points(std::size_t points, const char* where) {
    return text("cannot decide: only %zu points are %s in 5 or more photos", points, where);
}

/// The smallest number of parts of a model, for conclusions from a half-trained model.
inline constexpr std::size_t enough_parts = 30;

inline std::string too_few_parts(std::size_t parts, const char* kind) {
    return text("cannot decide: only %zu %s of the model are in 5 or more photos", parts, kind);
}

}  // namespace gs::features
