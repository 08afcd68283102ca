// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../losses/loss.hpp"
#include "../metrics/image_quality.hpp"
#include "../optimize/fault_report.hpp"

namespace gs::train {

/// What the training steps since the last report came to.
struct step_report {
    loss_report loss;           ///< means over these steps
    std::uint64_t skipped = 0;  ///< steps that changed nothing because their tile lists did not fit
    fault_reports faults;       ///< what was not finite; no parameter ever is: see `adam`
};

}  // namespace gs::train
