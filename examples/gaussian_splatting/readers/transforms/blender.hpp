// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../reader.hpp"

namespace gs {

/// Reads a folder like those of the NeRF-synthetic data set: `transforms_train.json`, and for the
/// held-out images `transforms_test.json`, or `transforms_val.json` if that does not exist.
extern const reader blender_reader;

}  // namespace gs
