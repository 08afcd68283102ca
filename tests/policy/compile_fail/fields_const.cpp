// expect only: all fields must have one type of components: pass float* to each at<N> for values of float
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, const float* more) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_reduce_atomic(model{}, warpagg::fields(warpagg::at<2>(to), warpagg::at<1>(more)), v, true);
}
