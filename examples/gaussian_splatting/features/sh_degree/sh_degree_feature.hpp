// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "../feature.hpp"

namespace gs::features {

/// View-dependent color by spherical harmonics. Values: the initial SH degree, and 1 if training
/// revises it after half of the iterations.
class sh_degree_feature final : public feature {
  public:
    std::string_view name() const override { return "direction"; }
    std::string_view costs_and_gains() const override {
        return "helps with glossy surfaces; can overfit noisy photos of matte ones; degree 3 takes four "
               "times "
               "the memory of degree 0";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    std::vector<float> neutral_values(const scene&) const override { return {3, 0}; }
    void prepare(const selected_feature& selected, scene&, gaussians& model) const override;
    void schedule(const selected_feature& selected, train::training& training) const override;
};

/// Returns the feature as `--sh-degree` specifies it.
selected_feature explicit_sh_degree(int degree);

/// Returns the initial SH degree from the values of the feature, or 0 if they are empty.
int first_sh_degree(const std::vector<float>& values);

/// Calls `revise` once, after half of the iterations, with the current SH degree, and sets the
/// degree that it returns. If `prune_change` is set, also prunes SH coefficients when the number of
/// Gaussians is final: see `sh_degree_state::prune`.
void schedule_revision(train::training& training, std::function<int(int sh_degree)> revise,
                       std::optional<double> prune_change);

}  // namespace gs::features
