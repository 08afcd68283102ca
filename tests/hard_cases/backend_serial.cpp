// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/simt/serial.hpp>

#include "device/cpu.hpp"
#include "on_device.hpp"

namespace hard_cases {

using one_lane = gs::device::basic_cpu<warpagg::emulator::serial>;

backend serial_backend() { return backend_on<one_lane, float>::make("serial"); }

const backend& reference() {
    static const backend b = backend_on<one_lane, double>::make("double");
    return b;
}

const std::vector<backend>& backends() {
    static const std::vector<backend> all {
        lanes_backend(), serial_backend(),
#if defined(WARPAGG_TEST_CUDA)
            cuda_backend(),
#endif
    };
    return all;
}

}  // namespace hard_cases
