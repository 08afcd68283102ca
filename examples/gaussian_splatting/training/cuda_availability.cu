// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cuda_runtime.h>

#include "../engine/engine.hpp"
#include "cuda_report.hpp"

namespace gs::train {

namespace {

/// Is compiled for the same architectures as all other kernels.
__global__ void probe() {}

cuda_report report_of_this_machine() {
    cuda_report report;
    cudaRuntimeGetVersion(&report.needed_version);
    cudaDriverGetVersion(&report.driver_version);
    cudaError_t status = cudaGetDeviceCount(&report.devices);
    if (status == cudaErrorNoDevice) return report;
    cudaDeviceProp properties{};
    if (status == cudaSuccess) status = cudaGetDeviceProperties(&properties, 0);
    if (status != cudaSuccess) {
        report.error = cudaGetErrorString(status);
        return report;
    }
    report.name = properties.name;
    report.major = properties.major;
    report.minor = properties.minor;
    cudaFuncAttributes kernel{};
    status = cudaFuncGetAttributes(&kernel, probe);
    report.program_has_its_code = status == cudaSuccess;
    const bool lacks_code = status == cudaErrorNoKernelImageForDevice ||
                            status == cudaErrorInvalidDeviceFunction ||
                            status == cudaErrorUnsupportedPtxVersion;
    if (!report.program_has_its_code && !lacks_code) report.error = cudaGetErrorString(status);
    return report;
}

}  // namespace

int count_gpus() {
    int count = 0;
    return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;
}

std::string bus_id_of_gpu() {
    char id[32] = "";
    return cudaDeviceGetPCIBusId(id, sizeof(id), 0) == cudaSuccess ? id : "";
}

bool cuda_is_available(std::string& reason) {
    reason = reason_against_gpu(report_of_this_machine());
    return reason.empty();
}

}  // namespace gs::train
