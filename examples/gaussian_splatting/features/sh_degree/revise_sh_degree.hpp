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

/// What a model in training says about the SH degree that its colors need.
struct sh_review {
    int sh_degree = 0;
    /// By degree, what is unexplained of the difference between photos and renders: see
    /// `direction_statistics::unexplained`.
    std::array<double, 4> unexplained{};
    /// Root mean square by which renders would change without the highest band; empty at degree 0.
    std::optional<double> change;
};

/// A band that changes renders by less is not needed: a render at 35 dB loses 0.014 dB by that.
inline constexpr double band_change_limit = 0.001;

/// By how much training views may change, as a root mean square, when single Gaussians lose their bands: see
/// `train::sh_degree_state::prune`.
inline constexpr double prune_change_limit = 0.00025;

/// Bands are needed if the difference between photos and renders depends on direction, or if they change the
/// renders of eight training views. Renders the training views once, and these eight again for each band.
/// `show` is that of the features in training. Precondition: `engine` has the scene's views, and a model of
/// this degree.
sh_review revise_sh_degree(train::engine& engine, const scene& scene, const show_function& show,
                           const std::array<float, 3>& background, int sh_degree);

}  // namespace gs::features
