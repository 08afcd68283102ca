// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "poses_on_device.hpp"

namespace gs::features {

/// A correction of the pose of each training photo, from the gradient of the loss. Cameras of a
/// rig move together. Initial values: see `initial_values`; if the photos call for the effect, training
/// begins with corrected poses. Learned values: `pose_width` per training view, zero for views that follow
/// another.
class poses_feature final : public feature {
  public:
    template <class Device>
    using on_device = poses_on_device<Device>;

    std::string_view name() const override { return "poses"; }
    std::string_view costs_and_gains() const override {
        return "helps if the poses of the cameras are not exact; iterations are slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool begins_from_photos() const override { return true; }
    std::vector<float> neutral_values(const scene& scene) const override;
    std::string obstacle(const scene& scene, const std::vector<float>& given) const override;
    void schedule(const selected_feature& selected, train::training& training) const override;
    /// Writes poses.json: the learned pose of each training photo and its difference from the given
    /// one, in world coordinates.
    void write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                       const std::filesystem::path& folder) const override;
};

}  // namespace gs::features
