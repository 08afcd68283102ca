// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "../scene/camera.hpp"

namespace gs::train {

/// The cameras of an engine, with poses that features have learned.
class learned_cameras {
  public:
    virtual ~learned_cameras() = default;

    /// Returns the camera of a training view with its learned pose. `given`: its camera in the scene, of any
    /// size. Waits for the device.
    virtual camera training_camera(std::size_t view, const camera& given) = 0;
    /// Returns the camera of a held-out view with a pose that fits the model better. Uses the left half
    /// of the photo, so the right half can serve for measurements. Costs 200 training steps.
    virtual camera refined_camera(std::size_t test_view, const std::array<float, 3>& background) = 0;
};

}  // namespace gs::train
