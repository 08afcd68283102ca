// expect only: the destination must have the type of the values: pass float* for values of float
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(double* to, unsigned key) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_match_reduce_atomic(model{}, to, key, v, true);
}
