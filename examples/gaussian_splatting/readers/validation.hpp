// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reader.hpp"

namespace gs {

/// The largest number of bytes in a file name. Linux has no longer ones, and std::filesystem needs
/// many times their size.
inline constexpr std::size_t longest_path = 4096;

/// Returns whether the focal lengths lie between 1e-6 and 1e9 pixels, and all other parameters are
/// finite and at most 1e9 in magnitude, so that no change of the image's size can overflow.
bool has_valid_intrinsics(const camera& taken_with, const lens& distortion);
inline constexpr const char* invalid_intrinsics =
    " has a focal length that is not between 1e-6 and 1e9, or a parameter that is not finite or beyond 1e9";

/// Returns the camera of a panorama at the origin. Throws `error`, which begins with `where`, unless
/// the panorama is twice as wide as high to within 2 %.
camera panorama_of_size(int width, int height, const std::string& where);

/// Returns whether a position is finite and at most 1e30 along each axis, so that squared distances
/// do not overflow.
bool is_valid_position(const glm::dvec3& position);
inline constexpr const char* invalid_position = " is not finite, or beyond 1e30";

/// Returns the rotation that is nearest to `matrix`, or nothing if `matrix` is a reflection or its
/// columns are not orthonormal to within 1e-3. Source: Newton's iteration for the polar
/// decomposition (Higham 1986, equation 3.3).
std::optional<glm::dmat3> nearest_rotation(const glm::dmat3& matrix);

/// Holds out every `load_options::test_every`-th image, sorted by name, from the first, if
/// `load_options::eval` is set. Throws `error` if `test_every` is less than 1.
void hold_out_views(std::vector<image_record>& images, const load_options& options);

}  // namespace gs
