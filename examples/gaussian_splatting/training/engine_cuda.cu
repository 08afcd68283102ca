// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cuda/cuda.hpp"
#include "device_engine.hpp"

namespace gs::train {

std::unique_ptr<engine> make_cuda_engine() { return std::make_unique<device_engine<device::cuda>>(); }

bool cuda_is_available(std::string& reason) {
    int devices = 0;
    const cudaError_t status = cudaGetDeviceCount(&devices);
    if (status != cudaSuccess) reason = cudaGetErrorString(status);
    if (status == cudaSuccess && devices == 0) reason = "no CUDA device";
    return status == cudaSuccess && devices > 0;
}

}  // namespace gs::train
