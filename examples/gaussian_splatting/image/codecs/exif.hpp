// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "../image.hpp"

namespace gs {

/// Returns the orientation that EXIF data specifies. The data begins with a TIFF header, which may
/// follow "Exif" and two zeros. Malformed data specifies no orientation.
orientation orientation_in_exif(std::span<const std::uint8_t> data);

}  // namespace gs
