// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include "compared_surfaces.hpp"

namespace gs::features {

/// What the differences between photos and a half-trained model show. Each result is computed on first use
/// and kept. Not thread-safe.
class half_way_statistics {
  public:
    half_way_statistics(const gs::scene& of, compared_surfaces compared)
        : scene_(of), compared_(std::move(compared)) {}

    const gs::scene& scene() const { return scene_; }
    /// Returns the falloff toward the corners of photos that the model does not explain, from surfaces and
    /// the sky: see `estimate_falloff`.
    const lens_falloff& falloff() const;
    /// Returns the response that the model does not explain, from surfaces without a clear falloff: see
    /// `estimate_response`. The sky of a photo has too few different colors.
    const tone_response& response() const;
    /// Returns the cells of all surfaces, without a clear falloff.
    observed_points parts() const;

  private:
    const gs::scene& scene_;
    compared_surfaces compared_;
    mutable std::optional<lens_falloff> falloff_;
    mutable std::optional<tone_response> response_;
};

}  // namespace gs::features
