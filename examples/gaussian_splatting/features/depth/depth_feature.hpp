// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "depth_on_device.hpp"

namespace gs::features {

/// Training with the depth maps of photos as a second target. Values: for each training photo, the
/// scale and offset from the map's values to inverse depths. A map with scale zero is not used.
class depth_feature final : public feature {
  public:
    template <class Device>
    using on_device = depth_on_device<Device>;

    std::string_view name() const override { return "depth"; }
    std::string_view costs_and_gains() const override {
        return "helps if photos and points are few; an iteration with a depth map takes up to twice the time";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    std::vector<float> neutral_values(const scene& scene) const override;
    std::string obstacle(const scene& scene, const std::vector<float>& values) const override;
    /// Removes depth maps that no step uses.
    void prepare(const selected_feature& selected, scene& scene, gaussians&) const override;
};

}  // namespace gs::features
