// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <omp.h>

#include "device/cpu/cpu.hpp"
#include "hold_on.hpp"

contest_result hold_on_cpu(const contest& c) {
    using gs::raster::cut;
    using device = gs::device::cpu;
    contest_on<device> on(c);
    on.enter_ladder<gs::raster::cut_for<device::warp>>();
    if (!c.of_accumulations) {
        on.enter_cut<cut<8, 2, 1024>>();
        on.enter_cut<cut<8, 16, 1024>>();
        on.enter_cut<cut<8, 4, 1024, true>>();
        on.enter_cut<cut<8, 8, 1024, true>>();
    }
    contest_result result = on.hold();
    result.cores = omp_get_max_threads();
    return result;
}
