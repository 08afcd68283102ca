// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <sched.h>
#include <unistd.h>

#include "transport.hpp"

namespace gs::ranks {

bool patient_wait::after_test() {
    constexpr int spins = 2000, yields = 200;
    if (tests_ >= spins + yields) {
        usleep(50);
        return true;
    }
    if (++tests_ <= spins) return false;
    sched_yield();
    return true;
}

}  // namespace gs::ranks
