// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "schedule.hpp"

namespace gs::train {

/// The state of a training run after an iteration.
struct training_moment {
    int iteration = 0;
    double seconds = 0;  ///< time of the loop so far
    std::size_t gaussians = 0;
};

/// Plans the number of iterations of a training run that is to last a given time.
///
/// It measures the time of steps in a window, and predicts the time of later steps from their image
/// size and number of Gaussians. The prediction is rough, so it is repeated: each window is a sixth
/// of the iterations that are left. The last one ends shortly before the run does, so that the error
/// of its prediction is a small part of the whole time.
class time_budget {
  public:
    /// The first plan follows after this many iterations, or earlier if the time is short.
    static constexpr int first_plan_after = 100;

    /// The number of Gaussians stays at or below `most_gaussians`.
    time_budget(double seconds, std::size_t most_gaussians)
        : seconds_(seconds), most_gaussians_(most_gaussians) {}

    /// Returns the last iteration of a run that continues after its time is over, or that continues
    /// after its `last` iteration with time left. Returns nothing for other runs.
    std::optional<int> correction_at_resume(const training_moment& now, int last) const;
    /// Begins to measure. Call it when training begins or continues.
    void begin(const training_moment& now, const schedule& schedule);
    /// Returns whether `correction` is called after this iteration.
    bool due(int iteration) const { return iteration >= next_; }
    /// Returns the last iteration with which the run lasts the given time, or nothing if the last
    /// iteration of `schedule` is near enough. The number of Gaussians changes until the iteration
    /// `count_is_final_after`.
    std::optional<int> correction(const training_moment& now, const schedule& schedule,
                                  int count_is_final_after);
    /// Begins the next window. Call it after a correction has changed `schedule`.
    void continue_from(const training_moment& now, const schedule& schedule);

  private:
    struct forecast;

    int last_iteration_within(double seconds, const forecast& rest) const;

    double seconds_;
    std::size_t most_gaussians_;
    training_moment window_;     ///< begin of the present window
    training_moment initial_;    ///< last known moment with the first number of Gaussians
    int next_ = 0;               ///< last iteration of the present window
    bool size_changes_ = false;  ///< whether images have another size in the next window
};

}  // namespace gs::train
