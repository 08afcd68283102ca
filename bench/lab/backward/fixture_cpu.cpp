// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <omp.h>

#include "device/cpu/cpu.hpp"
#include "fixture.hpp"

namespace gs::lab {

ranking rank_on_cpu(const ranking_setup& c) {
    using gs::raster::cut;
    using device = gs::device::cpu;
    fixture<device> on(c);
    on.enter_ladder<gs::raster::cut_for<device::warp>>();
    if (!c.compares_accumulations) {
        on.enter_cut<cut<8, 2, 1024>>();
        on.enter_cut<cut<8, 16, 1024>>();
        on.enter_cut<cut<8, 4, 1024, true>>();
        on.enter_cut<cut<8, 8, 1024, true>>();
    }
    ranking result = on.measure();
    result.cores = omp_get_max_threads();
    return result;
}

}  // namespace gs::lab
