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

/// The opacity up to which the strategy `mcmc` considers a Gaussian dead.
inline constexpr float dead_opacity = 0.005f;

/// Settings of the strategy `mcmc`. The numbers are those of Kheradmand et al. 2024; unlike there, noise
/// and scale penalty are relative to the extent of the scene.
struct mcmc_config {
    static constexpr std::string_view name = "mcmc";

    double noise = 5e5;             ///< see `add_noise`
    double opacity_penalty = 0.01;  ///< see `penalty_weights`
    double scale_penalty = 0.01;    ///< see `penalty_weights`

    /// A member of every strategy's settings: see `strategy_config`.
    /// @{
    std::vector<options::option> options();
    void check(const training_facts&) const {}
    mcmc_config resolved(const training_facts&) const { return *this; }
    std::optional<std::size_t> target_count() const { return {}; }
    /// @}
};

}  // namespace gs::train
