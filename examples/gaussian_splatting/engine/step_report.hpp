// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../losses/loss.hpp"
#include "../metrics/image_quality.hpp"
#include "../optimize/fault_report.hpp"

namespace gs::train {

/// The results of the training steps since the last report.
struct step_report {
    loss_report loss;           ///< means over these steps
    std::uint64_t skipped = 0;  ///< steps without effect: their tile lists exceeded the capacity
    fault_reports faults;       ///< values that were not finite; `adam` keeps parameters finite
};

}  // namespace gs::train
