// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cpu/cpu.hpp"
#include "measure_on.hpp"

namespace gs::lab {

paper_figures measure_on_cpu(const paper_subject& s) {
    using device = gs::device::cpu;
    using of_32_lanes = gs::device::basic_cpu<warpagg::emulator::lanes>;  // as a GPU's
    paper_bench<device> bench(s);
    return {bench.device_name(), device::warp::size, bench.kernels(), paper_bench<of_32_lanes>(s).active()};
}

}  // namespace gs::lab
