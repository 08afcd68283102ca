// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "cuda_report.hpp"

namespace gs::train {

namespace {

std::string version_text(int version) {
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

}  // namespace

std::string reason_against_gpu(const cuda_report& report) {
    const std::string needed = version_text(report.needed_version);
    if (report.driver_version == 0)
        return "no NVIDIA driver was found: install one that supports CUDA " + needed;
    // A driver runs programs of all minor versions of its CUDA version.
    if (report.driver_version / 1000 < report.needed_version / 1000)
        return "the NVIDIA driver supports CUDA " + version_text(report.driver_version) +
               ", but this program needs " + needed + ": update the driver";
    if (!report.error.empty()) return "CUDA reports '" + report.error + "'";
    if (report.devices == 0) return "the NVIDIA driver found no GPU";
    if (!report.program_has_its_code)
        return report.name + " has compute capability " + std::to_string(report.major) + "." +
               std::to_string(report.minor) +
               ", for which this program contains no code: build it for this GPU, or use a newer GPU";
    return "";
}

}  // namespace gs::train
