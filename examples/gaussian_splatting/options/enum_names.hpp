// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace gs::options {

/// The word of the command line for a value of an enumeration. Beside the enumeration, a function
/// `names_of(Enum)` returns the words of all values, in the order of the values, which count from 0.
template <class Enum>
std::string name_of(Enum value) {
    return std::string(names_of(value)[static_cast<std::size_t>(value)]);
}

/// All values of an enumeration, in their order.
template <class Enum>
inline constexpr auto all_values = [] {
    std::array<Enum, names_of(Enum{}).size()> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Enum>(i);
    return values;
}();

}  // namespace gs::options
