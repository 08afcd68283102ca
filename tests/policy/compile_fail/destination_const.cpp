// expect only: the destination must not be const
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(const float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, to, v, true);
}
