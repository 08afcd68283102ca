// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "feature_state.hpp"

namespace gs::train {

/// The state of view-dependent color on the device, which `engine::feature("direction")` returns.
/// It determines the memory layout of the model's parameters.
class sh_degree_state : public feature_state {
  public:
    /// Sets the SH degree. Frees the coefficients of higher degrees; coefficients of new degrees
    /// are zero.
    virtual void set_degree(int degree) = 0;
    /// Frees the SH coefficients above degree 0 of Gaussians whose colors hardly depend on
    /// direction, and gives these Gaussians their mean color over the training views. Chooses as
    /// many Gaussians as change those views by a root mean square of at most `change`, as estimated
    /// by `sh_error`. Chooses none if they are less than a tenth of those with coefficients.
    /// Reorders the Gaussians. The next densification gives all of them coefficients again. Cost:
    /// renders each training view at the smallest size. Returns the number of Gaussians that keep
    /// their coefficients.
    virtual std::size_t prune(double change) = 0;
};

}  // namespace gs::train
