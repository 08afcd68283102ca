// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "motion_on_device.hpp"

namespace gs::features {

/// The motion of the camera during the exposure of each training photo: blur and rolling shutter. Initial
/// values: for each training view, depth and angle of `motion_scale`, and values 0 to 5 of
/// `motion_values`. Learned values: `motion_width` per training view.
class motion_feature final : public feature {
  public:
    template <class Renderer>
    using on_device = motion_on_device<Renderer>;

    std::string_view name() const override { return "motion"; }
    std::string_view costs_and_gains() const override {
        return "helps if the camera moved while it took photos; iterations are slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool begins_from_photos() const override { return true; }
    std::vector<float> neutral_values(const scene& scene) const override;
    std::string obstacle(const scene& scene, const std::vector<float>& values) const override;
    void schedule(const selected_feature& selected, train::training& training) const override;
    /// Writes motion.json: the motion of each training photo in pixels per exposure, and the time for
    /// reading a photo.
    void write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                       const std::filesystem::path& folder) const override;
};

}  // namespace gs::features
