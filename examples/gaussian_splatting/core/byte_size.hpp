// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace gs {

/// Units of sizes in bytes, as users write them.
inline constexpr std::array<std::pair<std::string_view, std::uint64_t>, 9> byte_units{{
    {"B", 1},
    {"kB", 1000},
    {"KiB", std::uint64_t{1} << 10},
    {"MB", 1000 * 1000},
    {"MiB", std::uint64_t{1} << 20},
    {"GB", 1000 * 1000 * 1000},
    {"GiB", std::uint64_t{1} << 30},
    {"TB", std::uint64_t{1000} * 1000 * 1000 * 1000},
    {"TiB", std::uint64_t{1} << 40},
}};

/// Returns a size for messages and options, rounded up: "512MB".
inline std::string size_in_bytes(std::uint64_t bytes) {
    const std::uint64_t unit = bytes < 10'000'000 ? 1000 : 1'000'000;
    return std::to_string((bytes + unit - 1) / unit) + (unit == 1000 ? "kB" : "MB");
}

/// Returns a size in gigabytes with two decimal places: "3.21".
inline std::string in_gigabytes(double bytes) {
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", bytes / 1e9);
    return text;
}

}  // namespace gs
