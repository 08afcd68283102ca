// expect only: the values must be an array: copy a scalar, a float3 or a std::array into float values[N]
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to, float v) { warpagg::warp_reduce_atomic(model{}, to, v, true); }
