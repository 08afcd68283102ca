// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../feature.hpp"

namespace gs::features {

/// The 2D Mip filter: a splat that the pixel filter widens becomes fainter. The formulas are in
/// antialiasing.hpp; the model's flag `gaussians::antialiased` enables them.
class antialiasing_feature final : public feature {
  public:
    std::string_view name() const override { return "antialiasing"; }
    std::string_view costs_and_gains() const override {
        return "improves views from other distances than those of the photos; lowers quality slightly if all "
               "photos have the same distance";
    }
    finding analyze(const scene_statistics& statistics) const override;
    explanation explain(const scene_statistics& statistics, const finding& found) const override;
    void prepare(const selected_feature&, scene&, gaussians&) const override;
};

}  // namespace gs::features
