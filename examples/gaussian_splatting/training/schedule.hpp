// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace gs::train {

/// What happens when, and at which rates: the reference implementation's (Kerbl et al. 2023), its 30,000
/// iterations scaled to any number of them, but for what docs/gaussian_splatting.md says. Rates and intervals
/// are positive.
struct schedule {
    int iterations = 7000;
    int sh_degree = 3;
    int sh_degree_interval = 500;  ///< iterations between two bands
    double extent = 1;             ///< of the scene

    /// Of Adam. Those of positions are by extent and fall from `init` to `final`, geometrically.
    double position_lr_init = 1.6e-4, position_lr_final = 1.6e-6;
    double feature_lr = 2.5e-3;   ///< of the constant color
    std::optional<double> sh_lr;  ///< of colors that depend on direction: a tenth, where it is not said
    double opacity_lr = 2.5e-2, scaling_lr = 1e-2, rotation_lr = 1e-3;

    /// Coarse to fine: photos are shrunk by two `num_downscales` times at first, and once less after every
    /// `resolution_interval` iterations.
    int num_downscales = 1;
    std::optional<int> resolution_schedule;
    /// Colors that depend on direction learn in every so many iterations.
    int sh_update_interval = 1;

    int sh_degree_at(int iteration) const;
    bool updates_sh(int iteration) const { return iteration % sh_update_interval == 0; }
    /// The iteration after which it shows which bands are needed: half-way, but each has had its interval.
    int bands_are_known_after() const {
        return std::max(iterations / 2, (sh_degree + 1) * sh_degree_interval);
    }
    int downscales_at(int iteration) const;
    /// A fifth of the iterations for one shrinking, less for more, where it is not said. 0, which is for
    /// whole photos at once, where there are too few of them.
    int resolution_interval() const;
    double sh_rate() const { return sh_lr.value_or(feature_lr / 10); }
    /// Adam's rates by `parameter`.
    std::array<float, 8> rates_at(int iteration) const;
};

}  // namespace gs::train
