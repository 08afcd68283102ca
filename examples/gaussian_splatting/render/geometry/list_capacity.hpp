// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/core/compiler.hpp>

namespace gs::raster {

/// Tells kernels whether a view has no more instances than it may have, for which memory is reserved. If it
/// has more, the render is incomplete: the step is skipped and changes no parameter.
struct list_capacity {
    const std::uint64_t* required = nullptr;  ///< number of instances; null: no limit
    std::uint64_t reserved = 0;               ///< number of instances that it may have

    WARPAGG_HD bool exceeded() const { return required != nullptr && *required > reserved; }
};

}  // namespace gs::raster
