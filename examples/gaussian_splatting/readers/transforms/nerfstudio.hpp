// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../reader.hpp"

namespace gs {

/// Reads a folder as nerfstudio's `ns-process-data` writes it: `transforms.json` with all images,
/// of which every `test_every`-th is held out. Points come from the PLY file that it names.
extern const reader nerfstudio_reader;

}  // namespace gs
