// expect only: the base is a pointer to the record of key 0, or an accessor base(key, i) -> T*
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <warpagg/atomic.hpp>

#include "model.hpp"

KERNEL wrong(std::array<float, 3> sums, unsigned key) {
    const float v[3] = {1, 2, 3};
    warpagg::warp_match_reduce_atomic(model{}, sums, key, v, true);
}
