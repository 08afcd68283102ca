// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gs {

/// The number of iterations of a training run, and the corrections of that number while it runs.
/// Schedules read the progress and the milestones of the run from it. Both stay continuous across a
/// correction: progress goes on from its value to 1 at the new last iteration, and a milestone that
/// is passed stays where it was.
///
/// Copies share the corrections, so that every schedule of a run sees them. `first_iterations` makes
/// an independent plan.
class iteration_plan {
  public:
    /// Precondition: `iterations` is not negative.
    iteration_plan(int iterations = 7000) : entries_(std::make_shared<entries>(entries{{0, iterations}})) {}

    /// Reads a text such as "7000" or "7000,3400:7200", which plans 7000 iterations, and after
    /// iteration 3400 a total of 7200. Returns nothing for other texts, for a total above `most`, and
    /// for corrections that are not in order or whose total leaves no iteration.
    static std::optional<iteration_plan> parse(const std::string& text, int most);
    /// Returns the text that `parse` reads.
    std::string text() const;

    /// Returns the last iteration.
    int last() const { return entries_->back().last; }
    bool is_corrected() const { return entries_->size() > 1; }
    /// Returns the part of the run that is done after an iteration, from 0 to 1.
    double progress(int iteration) const;
    /// Returns the last iteration with at most this progress, from 0 to 1.
    int milestone(double progress) const;

    /// Sets the last iteration. Precondition: `after`, the iteration that has just ended, follows the
    /// previous correction and is less than `last`.
    void correct(int after, int last);
    /// Replaces the plan by another one, also in all copies.
    void replace(const iteration_plan& other) { *entries_ = *other.entries_; }
    /// Returns a plan with the corrections up to the end of `iteration` only.
    iteration_plan first_iterations(int iteration) const;
    /// Returns the last iteration that a correction after `iteration` sets, or nothing.
    std::optional<int> correction_after(int iteration) const;

    friend bool operator==(const iteration_plan& a, const iteration_plan& b) {
        return *a.entries_ == *b.entries_;
    }

  private:
    struct entry {
        int after, last;
        double progress = 0;  ///< after the iteration `after`
        bool operator==(const entry&) const = default;
    };
    using entries = std::vector<entry>;

    std::shared_ptr<entries> entries_;  ///< in order; the first one is the initial plan
};

}  // namespace gs
