// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace gs {

/// Returns the indices of Gaussians along a Morton curve, so that neighbors in the order are close
/// in space. `positions` has x y z of each, all finite. Gaussians at the same place keep their order.
std::vector<std::uint32_t> morton_order(const std::vector<float>& positions);

}  // namespace gs
