// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene.hpp"

namespace gs {

/// The camera of an image with its sides divided by `divisor` and rounded to the nearest pixel, at
/// least 1.
camera downsampled(const camera& full, int divisor);

/// The view with that camera; the photo and the depth map are averaged over areas.
view downsampled(const view& full, int divisor);

}  // namespace gs
