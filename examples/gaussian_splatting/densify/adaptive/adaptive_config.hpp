// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

namespace gs::train {

/// Settings of the strategy `adaptive`. Intervals are positive. Optional settings without a value follow from
/// the training: see `adaptive_schedule`.
struct adaptive_config {
    int densify_from_iter = 500;  ///< densifies after this iteration
    std::optional<int> densify_until_iter{};
    int densification_interval = 100;
    std::optional<double> densify_grad_threshold{};
    int opacity_reset_interval = 3000;
    std::optional<double> prune_share{};
    float least_opacity = 0.005f;  ///< removes Gaussians below it
    /// Number of Gaussians to grow to, evenly and regardless of the gradient threshold; 0: by the threshold.
    std::size_t budget = 0;
    bool revised_opacity = true;  ///< see `densify_config`
};

}  // namespace gs::train
