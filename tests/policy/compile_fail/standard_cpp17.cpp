// expect only: warpagg needs C++20: compile with -std=c++20
// standard: c++17
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, to, v, true);
}
