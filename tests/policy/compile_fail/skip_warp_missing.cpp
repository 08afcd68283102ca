// expect only: the first argument must be a warp, such as cuda_warp
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(float* to) {
    if (!warpagg::skip_if_warp_idle(to != nullptr)) *to = 1;
}
