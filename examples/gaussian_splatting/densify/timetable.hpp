// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../render/gradients/accumulator.hpp"

namespace gs::train {

/// What a densification strategy knows about the training that it is created for.
struct training_facts {
    int iterations = 7000;
    int views = 1;                  ///< number of training views
    double extent = 1;              ///< extent of the scene, see `scene::extent`
    bool white = false;             ///< images have transparent parts, which are shown on white
    std::size_t max_gaussians = 0;  ///< no strategy grows beyond this number
    std::uint64_t seed = 0;
    accumulator gradient = accumulator::native;  ///< in which score renders are summed
};

/// Result of `strategy::run`.
struct densify_report {
    std::size_t count = 0;               ///< Gaussians from now on
    std::uint64_t without_gradient = 0;  ///< Gaussians that were drawn, but received no gradient
};

/// When a densification strategy acts. This part runs on the host and does not depend on the device: the
/// training loop asks it. Iterations count from 1.
class timetable {
  public:
    virtual ~timetable() = default;
    /// Whether the step of this iteration collects statistics for `strategy::run`.
    virtual bool wants(int iteration) const = 0;
    /// Whether `strategy::run` is called after the step of this iteration.
    virtual bool due(int iteration) const = 0;
    /// The iteration after which `run` no longer changes the number of Gaussians.
    virtual int count_is_final_after() const = 0;
};

}  // namespace gs::train
