// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// The number of values of a motion.
inline constexpr unsigned motion_width = 7;

/// The motion of a camera while it takes a photo, as training learns it. See `camera_motion`, whose unit
/// of time is the exposure here. Values 0 to 2 turn the scene about the camera, in units of
/// `motion_scale::angle`, so that 1 is about one pixel. Values 3 to 5 shift it, and also turn it, so that
/// the point on the axis at `motion_scale::depth` stays: see `pose_change`. Value 6 is the time for
/// reading the photo, in units of `readout_unit` exposures.
using motion_values = std::array<float, motion_width>;

/// The unit of the time for reading a photo, in exposures. Photos with little blur may have much shear.
inline constexpr double readout_unit = 3;

/// A motion that hardly blurs a photo. Training begins from it, because the gradient of a blur is zero
/// without motion.
inline constexpr float small_motion = 0.5f;

/// The units of the motion of a view.
struct motion_scale {
    double depth;  ///< typical depth of the scene in the photo
    double angle;  ///< of a pixel at the center of the photo, in radians
};

/// Returns the scale of each training view.
std::vector<motion_scale> motion_scales(const scene& scene);

/// Converts values. Values that are not finite give no motion.
camera_motion motion_of(const motion_scale& scale, const motion_values& values);

/// Returns the motion during the exposure, in pixels, of the point on the axis at this depth.
glm::dvec2 blur_of(const camera& camera, const camera_motion& motion, double depth);

/// Sets the readout times of all photos to their mean, because a capture has one shutter. Photos that
/// moved more have more weight. The blur does not tell the direction of a motion, but the rolling
/// shutter does. A photo whose readout time has the other sign gets the opposite motion, which leaves
/// its renders unchanged. `values`: `motion_width` per view.
void share_readout(std::vector<float>& values);

}  // namespace gs::features
