// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "../model/gaussians.hpp"
#include "../scene/camera.hpp"

namespace gs::edit {

/// Returns the Gaussians with these indices, in this order.
gaussians select(const gaussians& model, std::span<const std::size_t> indices);

/// An axis-aligned box in the model's coordinates.
struct box {
    glm::dvec3 least{0}, most{0};
};

/// Removes Gaussians whose centers are outside the box. Centers on its faces stay.
gaussians crop(const gaussians& model, const box& kept);

/// Keeps the `count` most important Gaussians, in their order. The importance is the opacity times
/// the product of the two largest standard deviations, which is proportional to the largest area that
/// a Gaussian can cover. Returns the whole model if it has no more Gaussians. Of equally important
/// Gaussians, the first ones stay. Takes linear time.
gaussians decimate(const gaussians& model, std::size_t count);

/// A number of Gaussians, or a share of them.
struct share {
    std::size_t count = 0;  ///< used if `percent` is 0
    double percent = 0;     ///< 0 to 100

    /// Returns the number for a model, rounded up.
    std::size_t of(std::size_t gaussians) const;
    /// Returns "100000" or "25%".
    std::string text() const;
};

/// Removes Gaussians that contribute nothing but artifacts:
/// - opacity below `least_floater_opacity`;
/// - a largest standard deviation above the size of the scene, and above the distance from its
///   center: a veil around the whole scene. The size and the center are those of `normalization_of`;
/// - a center in the image of fewer than `least_floater_views` of the cameras. Not applied if there
///   are fewer cameras. Cameras are in the model's coordinates.
/// Takes time in proportion to the number of Gaussians times the number of cameras.
gaussians remove_floaters(const gaussians& model, std::span<const camera> cameras);
inline constexpr double least_floater_opacity = 0.02;
inline constexpr std::size_t least_floater_views = 2;

/// Rotates the model: positions, orientations and SH coefficients, including the learned background.
/// Precondition: `rotation` is orthonormal, with determinant 1.
gaussians rotate(const gaussians& model, const glm::dmat3& rotation);

/// Replaces the learned background by `sky_count` Gaussians on a sphere around the model, which any
/// viewer shows. They have the colors of the background as seen from the center of the model.
/// Gaussians far outside of the model end up behind the sphere. Returns a model without a learned
/// background as it is.
gaussians with_sky_gaussians(gaussians model);
inline constexpr std::size_t sky_count = 4096;

/// Returns the smallest rotation that turns the axis `up`, a unit vector, to -y, which viewers of
/// .ply files show upward.
glm::dmat3 upright(const glm::dvec3& up);

}  // namespace gs::edit
