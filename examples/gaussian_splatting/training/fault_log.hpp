// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../optimize/fault_report.hpp"
#include "../scene/scene.hpp"

namespace gs::train {

/// What was not finite in the steps of a training run, with the view in which it was found.
class fault_log {
  public:
    /// A step trained on this view.
    void steps(std::size_t view) { views_.push_back(view); }

    /// Looks at the faults of the steps since the last call, the last of which was `iteration`. Warns about
    /// the first gradient and the first sum that was left out. Throws `error` if the loss or a parameter is
    /// not finite.
    void check(const fault_reports& found, const scene& scene, int iteration,
               const std::function<void(const std::string&)>& warn);

    std::uint64_t left_out_gradients() const { return left_out_gradients_; }
    std::uint64_t left_out_sums() const { return left_out_sums_; }

  private:
    std::vector<std::size_t> views_;  ///< of the steps since the last check
    std::uint64_t left_out_gradients_ = 0, left_out_sums_ = 0;
};

}  // namespace gs::train
