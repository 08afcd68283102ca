// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace gs {

static_assert(std::endian::native == std::endian::little, "PLY rows are copied as they lie in memory");

/// The types of scalar properties in PLY files.
enum class ply_scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline std::optional<ply_scalar> ply_scalar_called(std::string_view name) {
    using enum ply_scalar;
    constexpr std::array<std::pair<std::string_view, ply_scalar>, 16> names = {{{"char", int8},
                                                                                {"uchar", uint8},
                                                                                {"short", int16},
                                                                                {"ushort", uint16},
                                                                                {"int", int32},
                                                                                {"uint", uint32},
                                                                                {"float", float32},
                                                                                {"double", float64},
                                                                                {"int8", int8},
                                                                                {"uint8", uint8},
                                                                                {"int16", int16},
                                                                                {"uint16", uint16},
                                                                                {"int32", int32},
                                                                                {"uint32", uint32},
                                                                                {"float32", float32},
                                                                                {"float64", float64}}};
    for (const auto& [known, type] : names) {
        if (name == known) return type;
    }
    return std::nullopt;
}

constexpr std::size_t size_of(ply_scalar type) {
    switch (type) {
        case ply_scalar::int8:
        case ply_scalar::uint8:
            return 1;
        case ply_scalar::int16:
        case ply_scalar::uint16:
            return 2;
        case ply_scalar::int32:
        case ply_scalar::uint32:
        case ply_scalar::float32:
            return 4;
        case ply_scalar::float64:
            break;
    }
    return 8;
}

/// Returns a value of a binary, little-endian PLY file. `bytes` need not be aligned.
inline double read_ply_scalar(ply_scalar type, const char* bytes) {
    const auto read_as = [&]<class T>(T value) {
        std::memcpy(&value, bytes, sizeof value);
        return static_cast<double>(value);
    };
    switch (type) {
        case ply_scalar::int8:
            return read_as(std::int8_t{});
        case ply_scalar::uint8:
            return read_as(std::uint8_t{});
        case ply_scalar::int16:
            return read_as(std::int16_t{});
        case ply_scalar::uint16:
            return read_as(std::uint16_t{});
        case ply_scalar::int32:
            return read_as(std::int32_t{});
        case ply_scalar::uint32:
            return read_as(std::uint32_t{});
        case ply_scalar::float32:
            return read_as(float{});
        case ply_scalar::float64:
            break;
    }
    return read_as(double{});
}

}  // namespace gs
