// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "exposure_on_device.hpp"

namespace gs::features {

/// An affine map of colors for each training photo (Kerbl et al. 2024, hierarchical 3D Gaussians).
/// Values: 12 per training view, see exposure_kernels.hpp.
class exposure_feature final : public feature {
  public:
    template <class Device>
    using on_device = exposure_on_device<Device>;

    std::string_view name() const override { return "exposure"; }
    std::string_view costs_and_gains() const override {
        return "helps if the same points are brighter in some photos than in others; iterations are slightly "
               "slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool begins_from_photos() const override { return true; }
    std::vector<float> neutral_values(const scene& scene) const override;
    void schedule(const selected_feature& selected, train::training& training) const override;
    show_function show_on_host(train::engine& engine, const scene& scene) const override;
    void before_evaluation(train::engine& engine, const scene& scene) const override;
    /// Writes exposures.json: three rows of four numbers per photo, as the reference implementation
    /// does.
    void write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                       const std::filesystem::path& folder) const override;
};

}  // namespace gs::features
