// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

namespace gs_fuzz {

/// Whether the loader took the file. An error that is no `gs::error`, or memory beyond the bound, leaves as
/// another exception, which libFuzzer takes for a crash.
using harness = bool(std::string_view input);

harness colmap_binary;  ///< its first byte chooses the part
harness colmap_text;    ///< its first byte chooses the part
harness transforms;
harness ply;
harness image;  ///< PNG and JPEG; a PNG's checksums are put right first

/// Beside the file's multiple: buffers of streams, and messages.
inline constexpr std::size_t small_change = 64 << 10;

/// Has `load` read a file of these bytes. Throws `std::logic_error` if it allocates, at any time, more than
/// four times the file's size, `small_change`, and what `further` says afterwards.
bool load_within_budget(
    std::string_view bytes, const std::function<void(const std::filesystem::path&)>& load,
    const std::function<std::size_t()>& further = [] { return std::size_t{0}; });

}  // namespace gs_fuzz
