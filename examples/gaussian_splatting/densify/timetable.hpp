// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../core/iteration_plan.hpp"
#include "../render/gradients/accumulator.hpp"

namespace gs::train {

/// The facts about a training that a densification strategy is created with.
struct training_facts {
    /// The plan of iterations. Training can correct it between two iterations, for example to finish
    /// in a given time; copies of the facts see the correction. So ask it again in each iteration,
    /// and take milestones and progress from it.
    iteration_plan iterations{};
    int views = 1;                       ///< number of training views
    std::size_t pixels = 0;              ///< number of pixels of all training views
    double extent = 1;                   ///< extent of the scene, see `scene::extent`
    bool white = false;                  ///< whether images have transparent parts, shown on white
    bool transparent = false;            ///< whether photos have transparent parts
    std::size_t max_gaussians = 0;       ///< largest number of Gaussians
    std::uint64_t max_device_bytes = 0;  ///< growth stops near this size of the device's memory; 0: none
    std::uint64_t seed = 0;
    accumulator gradient = accumulator::native;  ///< accumulator of the sums of scores
};

/// The result of `strategy::run`.
struct densify_report {
    std::size_t count = 0;               ///< new number of Gaussians
    std::uint64_t without_gradient = 0;  ///< number of drawn Gaussians without gradient
};

/// Decides when a densification strategy acts. It runs on the host, independent of the device; the
/// training loop calls it. Iterations count from 1.
class timetable {
  public:
    virtual ~timetable() = default;
    /// Returns whether the step of this iteration collects statistics for `strategy::run`.
    virtual bool wants(int iteration) const = 0;
    /// Returns whether `strategy::run` is called after the step of this iteration.
    virtual bool due(int iteration) const = 0;
    /// Returns the last iteration in which `run` may change the number of Gaussians.
    virtual int count_is_final_after() const = 0;
};

}  // namespace gs::train
