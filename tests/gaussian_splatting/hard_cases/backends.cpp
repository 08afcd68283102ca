// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/warp/serial.hpp>

#include "device/cpu/cpu.hpp"
#include "on_device.hpp"

namespace hard_cases {

const backend& reference() {
    static const backend b = make_backend<gs::device::basic_cpu<warpagg::emulator::serial>, double>("double");
    return b;
}

const std::vector<backend>& backends() {
    static const std::vector<backend> all {
        lanes_backend(),
#if defined(WARPAGG_ALL_BACKENDS)
            lanes_32_backend(), serial_backend(),
#endif
#if defined(WARPAGG_TEST_CUDA)
            cuda_backend(),
#endif
    };
    return all;
}

}  // namespace hard_cases
