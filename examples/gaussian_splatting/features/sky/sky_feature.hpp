// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "sky_on_device.hpp"

namespace gs::features {

/// A learned background whose color depends on the viewing direction. Values: the coefficients of
/// `gaussians::sky`.
class sky_feature final : public feature {
  public:
    template <class Device>
    using on_device = sky_on_device<Device>;

    std::string_view name() const override { return "sky"; }
    std::string_view costs_and_gains() const override {
        return "removes floaters in front of a sky; iterations are slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool begins_from_photos() const override { return true; }
    std::vector<float> neutral_values(const scene&) const override;
    std::string obstacle(const scene& scene, const std::vector<float>&) const override;
    void prepare(const selected_feature& selected, scene&, gaussians& model) const override;
};

}  // namespace gs::features
