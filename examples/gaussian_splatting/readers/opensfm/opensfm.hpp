// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../reader.hpp"

namespace gs {

/// Reads a folder of OpenSfM or OpenDroneMap (ODM): `reconstruction.json` or
/// `opensfm/reconstruction.json`, with photos, and possibly with masks and depth maps. Of several
/// reconstructions it reads the one with the most photos. Every `test_every`-th image is held out.
extern const reader opensfm_reader;

}  // namespace gs
