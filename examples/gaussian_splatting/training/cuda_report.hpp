// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gs::train {

/// What CUDA reports about this machine. Versions are numbers such as 13000 for 13.0.
struct cuda_report {
    int needed_version = 0;             ///< the CUDA version that this program needs
    int driver_version = 0;             ///< the CUDA version that the driver supports; 0 without a driver
    int devices = 0;                    ///< number of GPUs
    std::string name{};                 ///< of the first GPU
    int major = 0, minor = 0;           ///< compute capability of the first GPU
    bool program_has_its_code = false;  ///< this program contains code that the first GPU can run
    std::string error{};                ///< CUDA's message about any other error
};

/// Returns why no GPU can be used, with a remedy, or an empty text if one can be used. The text has
/// no period.
std::string reason_against_gpu(const cuda_report& report);

}  // namespace gs::train
