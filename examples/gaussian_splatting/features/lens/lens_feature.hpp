// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"

namespace gs::features {

/// Fisheye lenses and panoramas, which the renderer simulates. The cameras determine which views
/// have which lens.
class lens_feature final : public feature {
  public:
    std::string_view name() const override { return "lens"; }
    std::string_view costs_and_gains() const override {
        return "makes very wide photos usable; iterations are slightly slower";
    }
    bool is_selectable() const override { return false; }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
};

}  // namespace gs::features
