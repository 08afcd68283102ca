// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// Tells kernels whether the tile lists of a view fit in the memory that is reserved for them. If
/// they do not, the render is incomplete: the step is skipped and changes no parameter.
struct list_capacity {
    const std::uint64_t* required = nullptr;  ///< number of instances; null: no limit
    std::uint64_t reserved = 0;               ///< number of instances that fit

    WARPAGG_HD bool exceeded() const { return required != nullptr && *required > reserved; }
};

}  // namespace gs::raster
