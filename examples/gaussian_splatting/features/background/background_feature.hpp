// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"

namespace gs::features {

/// The constant background: white for photos with transparent parts, otherwise black.
/// `--background` overrides it.
class background_feature final : public feature {
  public:
    std::string_view name() const override { return "background"; }
    std::string_view costs_and_gains() const override { return "has no cost"; }
    bool is_selectable() const override { return false; }
    finding analyze(const scene_statistics& statistics) const override {
        const bool alpha = statistics.scene().has_alpha;
        return {alpha, alpha ? "photos have transparent parts" : "all photos are opaque",
                alpha ? "white" : "black"};
    }
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
};

}  // namespace gs::features
