// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "../../scene/scene.hpp"
#include "../feature.hpp"

namespace gs::train {
class engine;
}

namespace gs::features {

/// The SH degree that the colors of a model in training need, with the reasons.
struct sh_review {
    int sh_degree = 0;
    /// `direction_statistics::unexplained` of the difference between photos and renders.
    std::array<double, 4> unexplained{};
    /// Root mean square of the change of renders without the highest degree; empty at degree 0.
    std::optional<double> change;
};

/// An SH degree that changes renders by less is not needed. It corresponds to 0.014 dB for a render
/// at 35 dB.
inline constexpr double band_change_limit = 0.001;

/// The root mean square by which training views may change when single Gaussians lose their SH
/// coefficients above degree 0: see `train::sh_degree_state::prune`.
inline constexpr double prune_change_limit = 0.00025;

/// Determines the SH degree that colors need. A degree is needed if the difference between photos
/// and renders depends on direction, or if it changes the renders of eight training views. `show`
/// applies the features in training. Precondition: `engine` has the scene's views, and a model of
/// degree `sh_degree`. Cost: renders all training views once, and the eight views twice for each
/// degree examined.
sh_review revise_sh_degree(train::engine& engine, const scene& scene, const show_function& show,
                           const std::array<float, 3>& background, int sh_degree);

}  // namespace gs::features
