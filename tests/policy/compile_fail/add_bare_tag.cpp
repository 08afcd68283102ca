// expect only: the tags go into one policy: write policy{...}
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, unsigned key) {
    const model w;
    const float v[3] = {1, 2, 3};
    warpagg::match(w, key, true).add(to, v, warpagg::shfl_down);
}
