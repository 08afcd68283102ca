// expect only: several arrays are one destination: write fields(at<3>(a), at<2>(b))
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, float* more) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, warpagg::at<2>(to), warpagg::at<1>(more), v, true);
}
