// expect only: active must be a bool, whether this lane is active: an integer or a mask of lanes is not
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, unsigned key, unsigned activemask) {
    const float v[3] = {1, 2, 3};
    const auto peers = warpagg::match(model{}, key, activemask);
    peers.add(to, v);
}
