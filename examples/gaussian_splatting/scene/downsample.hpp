// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene.hpp"

namespace gs {

/// Returns the camera of the image with its sides divided by `divisor`. The sides are rounded to
/// the nearest pixel and are at least 1.
camera downsampled(const camera& full, int divisor);

/// Returns the view with this camera. Averages the photo and the depth map over areas.
view downsampled(const view& full, int divisor);

}  // namespace gs
