// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../ranks/communicator.hpp"

namespace gs::train {

/// An engine as one of several ranks, which train one model together.
class rank_member {
  public:
    virtual ~rank_member() = default;

    /// Makes the engine one of these ranks. At first it is the only one. Afterwards all ranks must call the
    /// functions alike that train the model, save its state or get it; one rank is enough to get a model
    /// directly after `set_model`.
    virtual void join(ranks::communicator& ranks) = 0;
    /// Gives this rank the values of all Gaussians, which renders of whole views need. All ranks must call
    /// it. Then each one can call `render`, `measure` and `refined_camera` alone, until the next call of
    /// `reserve`, `step`, `densify` or `take_report`. Not necessary with one rank, or directly after
    /// `set_model`.
    virtual void prepare_renders() = 0;
};

}  // namespace gs::train
