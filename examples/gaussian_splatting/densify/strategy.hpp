// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../model/parameters.hpp"
#include "../optimize/trained_parameters.hpp"
#include "../render/geometry/list_capacity.hpp"
#include "../render/project/project_backward.hpp"
#include "parameter_gather.hpp"
#include "score_views.hpp"
#include "timetable.hpp"

namespace gs::train {

/// The Gaussians in training. A strategy may change their parameters in place.
template <device::device Device>
struct trained_gaussians {
    Device& device;
    trained_parameters<Device>& parameters;
    std::size_t count;
    /// The Gaussians of this rank. Others have no moments here, and changes to their values are lost, unless
    /// a function mentions them.
    ranks::share own;
    int sh_degree;
    const glm::vec3* cameras;  ///< centers of the training cameras, in device memory
    std::size_t camera_count;
};

/// The argument of `strategy::after_step`.
template <device::device Device>
struct step_context : trained_gaussians<Device> {
    std::array<float, parameter_count> rates;  ///< learning rates of this step
    /// The capacity of the tile lists. If `capacity.exceeded()`, the step is skipped and kernels
    /// must change nothing.
    raster::list_capacity capacity;
};

/// The argument of `strategy::run`. All ranks call it alike. Each has the present values of all Gaussians,
/// apart from SH coefficients above degree 0, and must change those of all.
template <device::device Device>
struct run_context : trained_gaussians<Device> {
    /// The statistics of each Gaussian from the steps since the last `run`.
    const raster::visibility* statistics;
    parameter_gather<Device>& gather;  ///< moves Gaussians to their new places
    score_views& views;                ///< renders training views, to score pixels
    std::size_t most;                  ///< largest number of Gaussians for which there is memory
};

/// A densification strategy decides which Gaussians to add, move and remove. The engine creates one
/// for each training from the list in strategies.hpp and calls it in this order in each iteration:
///
///     (the training step, which collects statistics if `wants`)
///     after_step  at the end of the step
///     run         if `due`
///     adjust      after all other changes of the model between two steps
///
/// Equal calls with equal statistics must have equal results, so use only random numbers from
/// `counter_random` with `training_facts::seed`.
template <device::device Device>
class strategy : public timetable {
  public:
    /// Returns the names of the gradient columns that the strategy needs in addition to
    /// `raster::visibility`. Its creation fails if the backward pass does not sum one of them.
    virtual std::vector<std::string> gradient_columns() const { return {}; }

    /// Does the work of each step, such as noise or penalties on parameters. A GPU captures it as
    /// part of the step's graph: it may launch kernels, but must not wait or read a result.
    virtual void after_step(int /*iteration*/, const step_context<Device>& /*context*/) {}
    /// Returns a part of the step's graph key: see `device_feature::memory_key`. `after_step` may
    /// allocate memory only in the first step with a new key. The key already has the number of
    /// Gaussians.
    virtual std::size_t memory_key(int /*iteration*/) const { return 0; }

    /// Adds, moves and removes Gaussians. May wait for the device. Afterwards the statistics are
    /// zero.
    virtual densify_report run(int iteration, const run_context<Device>& context) = 0;

    /// Saves or loads the state that later calls depend on: see `state_archive`. An archive that
    /// loads has no such state if another strategy saved it.
    virtual void exchange(state_archive&) {}

    /// Changes parameters between two steps, for example in an opacity reset. Must keep the number
    /// and order of the Gaussians, and must not wait for the device.
    virtual void adjust(int /*iteration*/, const trained_gaussians<Device>& /*gaussians*/) {}
};

}  // namespace gs::train
