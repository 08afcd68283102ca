// expect only: the tags go into one policy: write policy{...}
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_match_reduce_atomic(model{}, to, 7u, v, true, warpagg::shfl_down, warpagg::skip);
}
