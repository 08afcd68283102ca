// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "colmap/colmap.hpp"
#include "reader.hpp"
#include "synthetic/synthetic.hpp"
#include "transforms/blender.hpp"

namespace gs {

std::span<const reader* const> all_readers() {
    static constexpr const reader* table[] = {
        &synthetic_reader,
        &blender_reader,
        &colmap_reader,
    };
    return table;
}

}  // namespace gs
