// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda/cuda.hpp"
#include "fixture.hpp"
#include "splat_per_lane.hpp"

namespace gs::lab {

ranking rank_on_cuda(const ranking_setup& c) {
    using gs::raster::cut;
    using device = gs::device::cuda;
    fixture<device> on(c);
    on.enter_ladder<gs::raster::cut_for<device::warp>>();
    if (!c.compares_accumulations) {
        on.enter_cut<cut<8, 1, 128>>();
        on.enter_cut<cut<8, 2, 64>>();
        on.enter_cut<cut<8, 2, 256>>();
        on.enter_cut<cut<8, 1, 64>>();
        on.enter_cut<cut<8, 4, 64>>();
        on.enter_cut<cut<8, 4, 128>>();
        on.enter_cut<cut<8, 4, 32>>();
        on.enter_cut<cut<16, 2, 128>>();
        on.enter_cut<cut<16, 4, 64>>();
        on.enter_cut<cut<16, 8, 128>>();
        on.enter("a splat a lane", false, on.renderer<splat_per_lane::cut>(), splat_per_lane{});
    }
    return on.measure();
}

}  // namespace gs::lab
