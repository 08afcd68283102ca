// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"

namespace gs::features {

/// Masked pixels. The readers apply masks to photos, and the losses skip masked pixels.
class masks_feature final : public feature {
  public:
    std::string_view name() const override { return "masks"; }
    std::string_view costs_and_gains() const override {
        return "keep moving objects out of the scene; have no cost";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    std::string obstacle(const scene& scene, const std::vector<float>&) const override;
};

}  // namespace gs::features
