// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"
#include "moving_on_device.hpp"

namespace gs::features {

/// Gives pixels a small weight in the loss if they show things that move while photos are taken, such as
/// people and cars: see `residual_weights`. It has no initial values.
class moving_feature final : public feature {
  public:
    template <class Renderer>
    using on_device = moving_on_device<Renderer>;

    std::string_view name() const override { return "moving"; }
    std::string_view costs_and_gains() const override {
        return "keeps things that appear in single photos out of the scene; iterations are slightly slower";
    }
    finding analyze(const scene_statistics& statistics) const override;
    bool may_begin_half_way() const override { return true; }
    finding review(const half_way_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
};

}  // namespace gs::features
