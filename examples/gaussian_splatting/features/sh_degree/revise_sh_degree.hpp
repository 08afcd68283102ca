// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "../../scene/scene.hpp"
#include "../../training/engine.hpp"

namespace gs::effects {

/// What a model in training says of the degree of spherical harmonics that its colours need.
struct band_review {
    int sh_degree = 0;  ///< that they need
    /// By degree, what is unexplained of what is left of the photos, see `evidence`; zeros where too few
    /// points tell.
    std::array<double, 4> unexplained{};
    /// By which pictures would change without the highest band, as a root mean square; none at degree 0.
    std::optional<double> change;
};

/// A band that changes pictures by less is not needed: a picture at 35 dB loses 0.014 dB by that.
inline constexpr double band_change_limit = 0.001;

/// By what training views may change at most, as a root mean square, when single Gaussians lose their bands:
/// see `train::engine::drop_bands`. Costs held-out views less than 0.02 dB (docs/effects.md).
inline constexpr double single_band_change_limit = 0.00025;

/// Bands are needed where what the model leaves of the photos depends on direction, and those of the model's
/// that change the pictures of eight training views. Draws the training views once, and these eight again by
/// band. Precondition: `engine` has the scene's views, and a model of this degree.
band_review review_bands(train::engine& engine, const scene& scene, const std::array<float, 3>& background,
                         int sh_degree);

}  // namespace gs::effects
