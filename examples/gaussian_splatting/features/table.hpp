// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <tuple>

#include "antialiasing/antialiasing_feature.hpp"
#include "background/background_feature.hpp"
#include "depth/depth_feature.hpp"
#include "exposure/exposure_feature.hpp"
#include "lens/lens_feature.hpp"
#include "masks/masks_feature.hpp"
#include "motion/motion_feature.hpp"
#include "moving/moving_feature.hpp"
#include "poses/poses_feature.hpp"
#include "response/response_feature.hpp"
#include "sh_degree/sh_degree_feature.hpp"
#include "sky/sky_feature.hpp"
#include "vignetting/vignetting_feature.hpp"

namespace gs::features {

/// All features, in the order in which `inspect` prints them and a step calls their hooks. A
/// feature with a device part has a member template `on_device<Renderer>`, which derives from
/// `device_feature<Renderer>`.
using table = std::tuple<sh_degree_feature, vignetting_feature, exposure_feature, response_feature,
                         antialiasing_feature, sky_feature, poses_feature, motion_feature, moving_feature,
                         masks_feature, depth_feature, lens_feature, background_feature>;

}  // namespace gs::features
