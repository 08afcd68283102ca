// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// The number of values of a pose change.
inline constexpr unsigned pose_width = 6;

/// A change of a camera pose, relative to the pose in the scene's files, in camera space of the given
/// pose of the leader: see `given_pose`. Values 0 to 2 turn the camera about its center: a rotation vector in
/// radians. Values 3 to 5 shift the center, in units of `shift_unit`. A shift also turns the camera, so that
/// the point on its axis at `given_pose::depth` stays at its place in the photo. A shift alone and a turn
/// would have similar effects on a photo, and gradient descent would converge slowly.
using pose_change = std::array<float, pose_width>;

/// The unit of shifts in a normalized scene. With a larger unit, one step moves the camera farther. Shifts
/// change photos only a little, so they would drift.
inline constexpr double shift_unit = 0.5;

/// A camera as the scene's files describe it. The cameras of a rig follow one of them, the leader: its
/// pose change moves all of them like one body. Other cameras are their own leaders.
struct given_pose {
    gs::camera camera;
    double depth;  ///< typical depth of the scene in the leader's photo; infinite for panoramas
    std::optional<std::size_t> leader{};  ///< index of the leader's view; empty if this camera leads
    glm::dmat3 from_leader{1};            ///< rotation from the leader's camera space to that of this camera
    glm::dvec3 lever{0};                  ///< center of this camera in the leader's camera space
};

/// Returns the pose of each training view. The depth is the median of a sample of the points in the
/// image, or the extent of the scene if there are too few. It is at least a twentieth of the extent. The
/// first view of a rig's frame is the leader of the others.
std::vector<given_pose> given_poses(const scene& scene);

/// The members of `given_pose` besides the camera as `given_width` numbers, which features keep.
/// @{
inline constexpr std::size_t given_width = 14;
std::array<float, given_width> numbers_of(const given_pose& given);
given_pose from_numbers(const camera& given, std::span<const float, given_width> numbers);
/// @}

/// Returns the camera with a changed pose. Any finite change gives a valid pose.
camera moved(const given_pose& given, const pose_change& change);

/// Returns the changes that move these cameras to their places, one camera per view. The change of a rig is
/// the mean of what its cameras need, and is the change of its leader. Views without a camera have no part in
/// it. Empty for other views than leaders, and for leaders without any camera.
std::vector<std::optional<pose_change>> changes_to(const std::vector<std::optional<camera>>& cameras,
                                                   const std::vector<given_pose>& given);

/// Convert gradients in world space to gradients with respect to a pose change.
struct pose_derivatives {
    glm::dmat3 by_turn;   ///< from the gradient with respect to a rotation about the center
    glm::dmat3 by_shift;  ///< from the gradient with respect to the center
    glm::dmat3 turning;   ///< from the gradient with respect to values 0 to 2; adds to the one of a shift
    glm::dmat3 by_lever;  ///< from the gradient with respect to the center; adds to the one of a turn
};

/// Returns the derivatives at a pose change. The rotation uses the left Jacobian of SO(3) (Sola et
/// al. 2018, equation 145).
pose_derivatives derivatives_of(const given_pose& given, const pose_change& change);

/// Removes two parts that the changes of all views have in common. One is a motion of the whole scene,
/// which no photo shows. The other is a change that is the same for all cameras in camera space, for
/// which the scene can nearly compensate. Without this, training drifts along both. Assumes that the
/// true changes have neither part. `given`: one pose per view. Fits both parts to the changes of leaders by
/// least squares.
void remove_common_motion(const std::vector<given_pose>& given, std::vector<float>& changes);

}  // namespace gs::features
