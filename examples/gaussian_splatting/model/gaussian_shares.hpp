// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../ranks/communicator.hpp"
#include "aosoa.hpp"

namespace gs {

/// Divides the Gaussians among the ranks. Shares consist of whole AoSoA blocks.
inline ranks::shares shares_of(std::size_t gaussians, const ranks::communicator& all) {
    return {gaussians, block_length, all.count()};
}

}  // namespace gs
