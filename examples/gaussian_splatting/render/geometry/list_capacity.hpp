// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// Whether a view's tile lists fit into the memory that was reserved for them, as the device finds out. A
/// step whose lists do not fit saw half an image: it is left out, and nothing is learned from it.
struct list_capacity {
    const std::uint64_t* required = nullptr;  ///< null: there is room enough
    std::uint64_t reserved = 0;

    WARPAGG_HD bool exceeded() const { return required != nullptr && *required > reserved; }
};

}  // namespace gs::raster
