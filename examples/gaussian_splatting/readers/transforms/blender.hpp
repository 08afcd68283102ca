// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../scene/scene.hpp"

namespace gs {

/// A scene as the NeRF-synthetic data set has them: `transforms_train.json` and, for the test views,
/// `transforms_test.json` or else `transforms_val.json`; without `eval` the test views are trained on too.
scene load_blender_scene(const load_options& options, const log_function& log);

}  // namespace gs
