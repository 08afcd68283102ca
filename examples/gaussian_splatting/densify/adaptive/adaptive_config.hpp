// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "../timetable.hpp"

namespace gs::options {
struct option;
}

namespace gs::train {

/// Settings of the strategy `adaptive`. Intervals are positive. The defaults of optional settings
/// depend on the training: see `adaptive_schedule`.
struct adaptive_config {
    static constexpr std::string_view name = "adaptive";

    int densify_from_iter = 500;  ///< densification begins after this iteration
    std::optional<int> densify_until_iter{};
    int densification_interval = 100;
    std::optional<double> densify_grad_threshold{};
    int opacity_reset_interval = 3000;
    std::optional<double> prune_share{};
    float least_opacity = 0.005f;  ///< opacity below which Gaussians are removed
    /// Number of Gaussians to grow to, evenly and regardless of the gradient threshold. Without a
    /// budget the threshold decides.
    std::optional<std::size_t> budget{};
    bool revised_opacity = true;              ///< see `densify_config`
    std::optional<double> opacity_penalty{};  ///< see `penalty_weights`

    /// A member of every strategy's settings: see `strategy_config`.
    /// @{
    std::vector<options::option> options();
    void check(const training_facts& facts) const;
    adaptive_config resolved(const training_facts& facts) const;
    std::optional<std::size_t> target_count() const { return budget; }
    /// @}
};

}  // namespace gs::train
