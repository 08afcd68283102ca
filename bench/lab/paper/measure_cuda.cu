// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda/cuda.hpp"
#include "measure_on.hpp"

namespace gs::lab {

paper_figures measure_on_cuda(const paper_subject& s) {
    using device = gs::device::cuda;
    paper_bench<device> bench(s);
    return {bench.device_name(), device::warp::size, bench.kernels(), bench.active()};
}

}  // namespace gs::lab
