// expect only: the argument active is missing: pass whether this lane is active, a bool
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, unsigned key) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_match_reduce_atomic(model{}, to, key, v);
}
