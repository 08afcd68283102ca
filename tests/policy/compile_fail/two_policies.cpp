// expect only: the tags go into one policy: write policy{...}
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, to, v, true, warpagg::policy{warpagg::shfl_down},
                                warpagg::policy{warpagg::skip});
}
