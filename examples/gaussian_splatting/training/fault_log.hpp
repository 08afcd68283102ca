// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../optimize/fault_report.hpp"
#include "../scene/scene.hpp"

namespace gs::train {

/// Reports values that were not finite in the steps of a training run, with the view of the step.
class fault_log {
  public:
    /// Records that a step has trained on these views. Call it for each step.
    void steps(std::vector<std::size_t> views) { views_.push_back(std::move(views)); }

    /// Processes the faults of all steps since the last call. `iteration` is the last of these
    /// steps. Warns about the first gradient and the first sum that was left out. Throws `error` if
    /// the loss is not finite, or if a parameter would not be finite.
    void check(const fault_reports& found, const scene& scene, int iteration,
               const std::function<void(const std::string&)>& warn);

    void exchange(state_archive& archive) {
        archive.exchange("left_out_gradients", left_out_gradients_);
        archive.exchange("left_out_sums", left_out_sums_);
    }

    std::uint64_t left_out_gradients() const { return left_out_gradients_; }
    std::uint64_t left_out_sums() const { return left_out_sums_; }

  private:
    std::vector<std::vector<std::size_t>> views_;  ///< of the steps since the last check
    std::uint64_t left_out_gradients_ = 0, left_out_sums_ = 0;
};

}  // namespace gs::train
