// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace gs::options {

/// Returns the word of the command line for a value of an enumeration. Precondition: the namespace
/// of the enumeration has a function `names_of(Enum)`, which returns the words of all values in
/// order. Values count from 0.
template <class Enum>
std::string name_of(Enum value) {
    return std::string(names_of(value)[static_cast<std::size_t>(value)]);
}

/// The values of an enumeration, in order.
template <class Enum>
inline constexpr auto all_values = [] {
    std::array<Enum, names_of(Enum{}).size()> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Enum>(i);
    return values;
}();

}  // namespace gs::options
