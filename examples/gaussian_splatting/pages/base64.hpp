// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace gs::pages {

std::string base64(std::span<const std::uint8_t> bytes);

/// Returns the number of characters of bytes in base64.
constexpr std::uint64_t base64_size(std::uint64_t bytes) { return (bytes + 2) / 3 * 4; }

/// Writes the bytes that `fill` writes to its stream, in base64. They may have any size: only a part
/// of them is in memory. Writes each part, of up to 3 MiB, between `before` and `after`.
void write_base64(std::ostream& out, const std::function<void(std::ostream&)>& fill, std::string_view before,
                  std::string_view after);

}  // namespace gs::pages
