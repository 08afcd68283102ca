// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace gs::train {

/// What one training step does.
struct step_plan {
    int iteration = 0;       ///< counts from 1; less than 2^24
    std::size_t view = 0;    ///< index of the training view
    int sh_degree = 0;       ///< of the colors that are drawn
    bool updates_sh = true;  ///< if false, view-dependent color is drawn but does not change
    std::array<float, 3> background{};
    std::array<float, 8> rates{};  ///< Adam's learning rates by `parameter`
};

}  // namespace gs::train
