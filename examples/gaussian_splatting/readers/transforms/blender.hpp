// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../reader.hpp"

namespace gs {

/// A folder like those of the NeRF-synthetic data set: `transforms_train.json` and, for the
/// held-out images, `transforms_test.json` or otherwise `transforms_val.json`.
extern const reader blender_reader;

}  // namespace gs
