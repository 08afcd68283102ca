// expect only: active must be a bool, whether this lane is active: an integer or a mask of lanes is not
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, unsigned activemask) {
    if (!warpagg::skip_if_warp_idle(model{}, activemask)) *to = 1;
}
