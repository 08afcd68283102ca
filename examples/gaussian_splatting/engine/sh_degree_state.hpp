// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "feature_state.hpp"

namespace gs::train {

/// View-dependent color on the device, as `engine::feature("direction")` returns it. It decides about the
/// layout of the model's parameters.
class sh_degree_state : public feature_state {
  public:
    /// From now on colors depend on direction up to this degree. Higher bands are freed; new ones are zero.
    virtual void set_degree(int degree) = 0;
    /// Frees the bands of Gaussians whose colors hardly depend on direction and gives these Gaussians their
    /// mean color over the training views: of as many as change those views by a root mean square of at most
    /// `change`, as estimated by `sh_error`; of none if they are less than a tenth. Gaussians change their
    /// places. All have bands again after the next densification. Draws the training views at the smallest
    /// size. Returns how many Gaussians keep their bands.
    virtual std::size_t prune(double change) = 0;
};

}  // namespace gs::train
