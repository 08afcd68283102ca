// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "response_on_device.hpp"

namespace gs::features {

/// The tone curve of a camera, for each lens and color channel: see response_kernels.hpp. Without exposures
/// that differ, the colors of the scene can have any curve. Values: see `response_values`.
class response_feature final : public feature {
  public:
    template <class Renderer>
    using on_device = response_on_device<Renderer>;

    std::string_view name() const override { return "response"; }
    std::string_view costs_and_gains() const override {
        return "helps if brighter photos change dark and bright colors by different factors, together with "
               "exposure; iterations are slightly slower";
    }
    std::string_view needs() const override { return "exposure"; }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    bool may_begin_half_way() const override { return true; }
    finding review(const half_way_statistics& statistics) const override;
    std::vector<float> neutral_values(const scene& scene) const override;
    std::string obstacle(const scene& scene, const std::vector<float>& values) const override;
    show_function show_on_host(train::engine& engine, const scene& scene) const override;
    void before_evaluation(train::engine& engine, const scene& scene) const override;
    /// Changes the colors to those that the response of most photos shows: see `respond_in_model`.
    void before_saving(train::engine& engine, const scene& scene, gaussians& model) const override;
    /// Writes response.json: for each lens, samples of the curves of the channels.
    void write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                       const std::filesystem::path& folder) const override;
};

}  // namespace gs::features
