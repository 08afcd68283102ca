// expect: the fields must have as many components as there are values
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, float* more) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, warpagg::fields(warpagg::at<1>(to), warpagg::at<1>(more)), v, true);
}
