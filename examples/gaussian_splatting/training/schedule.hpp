// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "../core/iteration_plan.hpp"

namespace gs::train {

/// The learning rates, the image size and the SH degree of each iteration. Based on the schedule of
/// Kerbl et al. 2023, scaled from 30,000 iterations to any number. Rates and intervals are
/// positive.
struct schedule {
    iteration_plan iterations{};
    int sh_degree = 3;
    int sh_degree_interval = 500;  ///< iterations between two increases of the SH degree
    double extent = 1;             ///< see `scene::extent`
    int views = 1;                 ///< number of training views
    /// Whether photos have transparent parts. Such photos show where the scene is empty. Gaussians
    /// then need no regularization and may move faster.
    bool transparent = false;
    bool rendered = false;  ///< see `scene::rendered`

    /// Learning rates of Adam. Rates of positions are relative to the extent and decay
    /// exponentially from `init` to `final`: see `position_rate_init` and `position_progress`.
    std::optional<double> position_lr_init, position_lr_final;
    double feature_lr = 2.5e-3;   ///< learning rate of SH degree 0
    std::optional<double> sh_lr;  ///< learning rate of SH degrees 1 to 3; see `sh_rate`
    double opacity_lr = 2.5e-2, scaling_lr = 1e-2, rotation_lr = 1e-3;

    std::optional<double> dropout;  ///< see `dropout_share`

    /// Images are halved `num_downscales` times at first, and once less after every
    /// `resolution_interval` iterations.
    int num_downscales = 1;
    std::optional<int> resolution_schedule;  ///< see `resolution_interval`
    int sh_update_interval = 1;              ///< iterations between updates of SH degrees 1 to 3

    int sh_degree_at(int iteration) const;
    bool updates_sh(int iteration) const { return iteration % sh_update_interval == 0; }
    /// Returns the iteration after which the SH degree is revised, which is `degree` at first: half
    /// of the iterations, or the end of the last degree's interval if that is later.
    int bands_are_known_after(int degree) const {
        return std::max(iterations.milestone(0.5), (degree + 1) * sh_degree_interval);
    }
    int downscales_at(int iteration) const;
    /// Returns the number of iterations between two doublings of the image size. It is
    /// `resolution_schedule`. If that is unset, images have full size after 6/5, 3/2 or 8/5 of
    /// `default_growth_end` for 1, 2 or 3 `num_downscales`: details of photos take few iterations
    /// once the Gaussians are in place. `rendered` images have full size after 2/5, 2/3 or 6/7 of
    /// it, because models of them come close enough to be limited by details. Returns 0 if the run is
    /// too short; images then have full size.
    int resolution_interval() const;
    /// Returns the first and the last learning rate of positions. The defaults are those of Kerbl
    /// et al. 2023, or 2 and 5 times as large for `transparent` photos.
    /// @{
    double position_rate_init() const { return position_lr_init.value_or(transparent ? 3.2e-4 : 1.6e-4); }
    double position_rate_final() const { return position_lr_final.value_or(transparent ? 8e-6 : 1.6e-6); }
    /// @}
    /// Returns how far the rate of positions has fallen, from 0 to 1. This is the progress of the
    /// run, but 1 at twice `default_growth_end` if that comes first: Gaussians that still move
    /// much while their number grows become more, and fit single photos.
    double position_progress(int iteration) const;
    /// Returns the learning rate of SH degrees 1 to 3: `sh_lr`, or if it is unset, a tenth of
    /// `feature_lr`, or a fifth for `transparent` photos.
    double sh_rate() const { return sh_lr.value_or(feature_lr / (transparent ? 5 : 10)); }
    /// Returns the share of the Gaussians that each step leaves out: see `raster::dropout`. The
    /// default is 0.05, or 0 for `transparent` photos.
    double dropout_share() const { return dropout.value_or(transparent ? 0 : 0.05); }
    /// Returns Adam's learning rates by `parameter`. In the last fifth of the run, all rates but that
    /// of positions fall exponentially to a tenth, so that the parameters come to rest.
    std::array<float, 8> rates_at(int iteration) const;
};

}  // namespace gs::train
