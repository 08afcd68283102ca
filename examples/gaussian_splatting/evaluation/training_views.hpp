// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "../engine/engine.hpp"
#include "../features/feature.hpp"

namespace gs::evaluate {

/// A training view as training compares it: three planes each, with values in [0, 1]. Masked pixels
/// of the render are those of the target.
struct training_view_images {
    std::vector<float> render, target;
    std::size_t masked = 0;  ///< number of masked pixels

    /// Returns the PSNR of the other pixels in dB; infinite if they are equal.
    double psnr() const;
};

/// Renders a training view of `scene`, which `engine` must hold, and decodes its photo. `show`
/// applies the learned effects, such as exposures: see `feature_set::show_on_host`.
training_view_images training_view(train::engine& engine, const scene& scene,
                                   const features::show_function& show,
                                   const std::array<float, 3>& background, std::size_t view);

}  // namespace gs::evaluate
