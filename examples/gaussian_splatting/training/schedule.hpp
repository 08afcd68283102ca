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
    bool white = false;            ///< photos without a background, shown on white

    /// Of Adam. Those of positions are by extent and fall from `init` to `final`, geometrically.
    double position_lr_init = 1.6e-4, position_lr_final = 1.6e-6;
    double feature_lr = 2.5e-3;   ///< of the constant colour
    std::optional<double> sh_lr;  ///< of colours that depend on direction: a tenth, where it is not said
    double opacity_lr = 2.5e-2, scaling_lr = 1e-2, rotation_lr = 1e-3;

    int opacity_reset_interval = 3000;
    int densification_interval = 100;
    int densify_from_iter = 500;
    std::optional<int> densify_until_iter;  ///< half of the iterations, at most 15,000, where it is not said
    std::optional<double> densify_grad_threshold;  ///< see `growth_threshold`

    /// Coarse to fine: photos are shrunk by two `num_downscales` times at first, and once less after every
    /// `resolution_interval` iterations.
    int num_downscales = 1;
    std::optional<int> resolution_schedule;
    /// Colours that depend on direction learn in every so many iterations.
    int sh_update_interval = 1;

    /// Of the Gaussians, those that matter least are dropped when densification has ended.
    std::optional<double> prune_share;

    static constexpr float reset_opacity = 0.01f;

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
    /// Adam's rate of exposures, which falls to a tenth: each can come as far as 0.6, however few steps show
    /// its photo, unless those are fewer than 30. In Kerbl et al. 2024's implementation it falls from 0.01.
    float exposure_rate_at(int iteration, int views) const;
    /// Adam's rate of a sky's coefficients, which falls to a hundredth.
    float sky_rate_at(int iteration) const;
    /// Of the mean error of inverse depths, in the frame whose extent is `internal_extent`: falls from 1 to a
    /// hundredth, as in Kerbl et al. 2024's implementation, whose unit is that of structure from motion.
    float depth_weight_at(int iteration) const;
    int densify_until() const;
    /// A Gaussian grows from this mean gradient of its centre, in halves of the picture. Where it is not
    /// said, it is 8e-5 if densification lasts 15,000 iterations, and more, by the fourth root, if it is
    /// shorter: a short training has no time for many Gaussians (docs/gaussian_splatting.md).
    double growth_threshold() const;
    /// `prune_share`; where it is not said, a fifth of those that densification has grown.
    double share_to_prune() const;
    /// The iteration after which `share_to_prune` is dropped, when each of the training views has been seen
    /// about once since the last densification; 0 for none.
    int prune_after(int views) const;
    /// The iteration after which the number of Gaussians stays.
    int count_is_final_after(int views) const { return std::max(densify_until(), prune_after(views)); }
    bool watches(int iteration, int views) const {
        return iteration < densify_until() || iteration <= prune_after(views);
    }
    bool densifies(int iteration) const;
    /// How many densifications there are in this iteration and after it. Precondition: it is not past the
    /// last.
    int densifications_from(int iteration) const;
    /// Every interval, but not in densification's last one: what a reset took back has to grow again. On
    /// white once more, when densification begins.
    bool resets_opacity(int iteration) const;
};

}  // namespace gs::train
