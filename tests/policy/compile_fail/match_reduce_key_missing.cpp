// expect only: the key must be an integer, the index of this lane's record
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_match_reduce_atomic(model{}, to, v, true);
}
