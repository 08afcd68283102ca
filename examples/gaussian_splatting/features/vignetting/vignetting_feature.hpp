// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "vignetting_on_device.hpp"

namespace gs::features {

/// A falloff toward the corners of photos, for each lens and color channel: see vignetting_kernels.hpp.
/// Values: see `falloff_values`.
class vignetting_feature final : public feature {
  public:
    template <class Renderer>
    using on_device = vignetting_on_device<Renderer>;

    std::string_view name() const override { return "vignetting"; }
    std::string_view costs_and_gains() const override {
        return "helps if photos are darker toward their corners; iterations are slightly slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool begins_from_photos() const override { return true; }
    bool may_begin_half_way() const override { return true; }
    finding review(const half_way_statistics& statistics) const override;
    std::vector<float> neutral_values(const scene& scene) const override;
    std::string obstacle(const scene& scene, const std::vector<float>& values) const override;
    show_function show_on_host(train::engine& engine, const scene& scene) const override;
    void before_evaluation(train::engine& engine, const scene& scene) const override;
    /// Writes vignetting.json: for each lens, the factors of the channels by distance from the center.
    void write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                       const std::filesystem::path& folder) const override;
};

}  // namespace gs::features
