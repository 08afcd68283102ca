// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace gs::train {

/// The inputs of one training step.
struct step_plan {
    int iteration = 0;       ///< number of the step, from 1; less than 2^24
    std::size_t view = 0;    ///< index of the training view
    int sh_degree = 0;       ///< SH degree of the rendered colors
    bool updates_sh = true;  ///< if false, the step does not change view-dependent color
    std::array<float, 3> background{};
    std::array<float, 8> rates{};  ///< Adam's learning rates by `parameter`
};

}  // namespace gs::train
