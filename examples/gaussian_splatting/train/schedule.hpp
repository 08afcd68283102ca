// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace gs::train {

/// What happens when, and at which rates: the reference implementation's (Kerbl et al. 2023), its 30,000
/// iterations scaled to any number of them.
struct schedule {
    int iterations = 7000;
    int sh_degree = 3;
    int sh_degree_interval = 1000;  ///< iterations between two bands
    double extent = 1;              ///< of the scene
    bool white = false;             ///< photos without a background, shown on white

    static constexpr double ssim_weight = 0.2;
    static constexpr int densify_from = 500, densify_every = 100, opacity_reset_every = 3000;
    static constexpr float reset_opacity = 0.01f;

    int sh_degree_at(int iteration) const;
    /// Adam's rates by `parameter`.
    std::array<float, 8> rates_at(int iteration) const;
    /// Half of the iterations, at most 15,000.
    int densify_until() const;
    bool watches(int iteration) const { return iteration < densify_until(); }
    bool densifies(int iteration) const;
    bool resets_opacity(int iteration) const;
    /// Gaussians that are large in the world are dropped once opacities have been reset. Those that are large
    /// on the screen are not: that costs lego 1.7 dB.
    bool drops_large(int iteration) const { return iteration > opacity_reset_every; }
};

}  // namespace gs::train
