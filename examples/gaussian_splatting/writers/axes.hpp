// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace gs {

/// Signs that turn a model around its x axis by 180°. A model with y down and z forward, as in
/// COLMAP and .ply files, gets y up and z backward, as SPZ and glTF prescribe, and vice versa.
namespace turn_about_x {

inline constexpr std::array<float, 3> position{1, -1, -1};
/// Signs of w x y z.
inline constexpr std::array<float, 4> rotation{1, 1, -1, -1};
/// Signs of the SH coefficients above degree 0, in the order of `sh_basis`.
inline constexpr std::array<float, 15> sh{-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1};

}  // namespace turn_about_x

}  // namespace gs
