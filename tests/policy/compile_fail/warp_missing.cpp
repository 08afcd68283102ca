// expect only: the first argument must be a warp, such as cuda_warp
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(to, v, true);
}
