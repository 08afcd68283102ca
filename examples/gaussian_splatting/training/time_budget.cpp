// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "time_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../options/option_value.hpp"

namespace gs::train {
namespace {

constexpr double short_time = 0.25;       ///< share of the time after which it is short
constexpr double last_correction = 0.01;  ///< share of the time that is too short for another window
constexpr double tolerance = 0.005;       ///< share of the time
constexpr double rest_tolerance = 0.04;   ///< share of the time that is left
constexpr double expected_growth = 2.5;   ///< of the number of Gaussians, before the first densification

/// Returns the time of a step relative to a step with one Gaussian and images of full size. The ratios
/// lie between those of small and of large images on CPUs and GPUs.
double cost(int level, double gaussians) {
    constexpr double per_halving = 0.5;
    return std::pow(per_halving, level) * std::sqrt(std::max(gaussians, 1.0));
}

}  // namespace

/// The expected course of the run after an iteration.
struct time_budget::forecast {
    training_moment now;
    const train::schedule& schedule;
    double final_count_at;    ///< progress after which the number of Gaussians stays the same
    double final_count;       ///< expected number of Gaussians
    double seconds_per_cost;  ///< measured

    /// Returns the time from now to the end if `last` is the last iteration.
    double seconds_until(int last) const {
        train::schedule s = schedule;
        s.iterations = schedule.iterations.first_iterations(now.iteration);
        s.iterations.correct(now.iteration, last);
        const int growth_ends = std::max(now.iteration + 1, s.iterations.milestone(final_count_at));
        const auto count = static_cast<double>(now.gaussians);
        constexpr int samples = 64;
        double sum = 0;
        for (int k = 0; k < samples; ++k) {
            const double i = now.iteration + (k + 0.5) / samples * (last - now.iteration);
            const double grown = std::min(1.0, (i - now.iteration) / (growth_ends - now.iteration));
            sum += cost(s.downscales_at(static_cast<int>(i) + 1), count + grown * (final_count - count));
        }
        return seconds_per_cost * sum / samples * (last - now.iteration);
    }
};

std::optional<int> time_budget::correction_at_resume(const training_moment& now, int last) const {
    if (now.iteration == 0) return {};
    const double left = seconds_ - now.seconds;
    if (left <= 0 && now.iteration + 1 < last) return now.iteration + 1;
    const double more = left / now.seconds * now.iteration;
    if (now.iteration < last || more < 1) return {};
    return static_cast<int>(std::min<double>(options::most_iterations, now.iteration + more));
}

void time_budget::begin(const training_moment& now, const schedule& schedule) {
    initial_ = now;
    continue_from(now, schedule);
}

void time_budget::continue_from(const training_moment& now, const schedule& schedule) {
    const int left = schedule.iterations.last() - now.iteration;
    const bool is_after_change = size_changes_;
    // Single steps vary. The first one is slower, because it allocates memory.
    const bool is_long_enough = now.iteration <= 1 || now.iteration >= first_plan_after;
    if (is_long_enough || size_changes_ || window_.iteration == 0) window_ = now;
    size_changes_ = false;
    if (left <= 1 || seconds_ - now.seconds < last_correction * seconds_) {
        next_ = std::numeric_limits<int>::max();
        return;
    }
    const int so_far = std::max(1, now.iteration);
    int length = std::max(1, std::min(so_far, left / (is_after_change ? 12 : 6)));
    if (now.iteration < first_plan_after) length = std::min(length, first_plan_after - now.iteration);
    const int level = schedule.downscales_at(now.iteration + 1);
    // Images of one size only: the window ends with the last step before they change.
    if (schedule.downscales_at(now.iteration + length + 1) != level) {
        while (schedule.downscales_at(now.iteration + length) != level) --length;
        size_changes_ = true;
    }
    next_ = now.iteration + length;
}

std::optional<int> time_budget::correction(const training_moment& now, const schedule& schedule,
                                           int count_is_final_after) {
    if (now.gaussians == initial_.gaussians) initial_ = now;
    const bool is_early = now.iteration < first_plan_after && now.seconds < short_time * seconds_;
    if (is_early || size_changes_) return {};
    const double before = static_cast<double>(window_.gaussians), count = static_cast<double>(now.gaussians);
    const double window_cost = (now.iteration - window_.iteration) *
                               cost(schedule.downscales_at(now.iteration), (before + count) / 2);
    double final_count = count;
    if (now.iteration < count_is_final_after) {
        const double grown = count - static_cast<double>(initial_.gaussians);
        final_count = grown == 0 ? expected_growth * count
                                 : count + std::max(grown, 0.0) / (now.iteration - initial_.iteration) *
                                               (count_is_final_after - now.iteration);
    }
    final_count = std::min(final_count, std::max(count, static_cast<double>(most_gaussians_)));
    const forecast rest{now, schedule, schedule.iterations.progress(count_is_final_after), final_count,
                        (now.seconds - window_.seconds) / window_cost};
    const double left = seconds_ - now.seconds;
    const double error = rest.seconds_until(schedule.iterations.last()) - left;
    if (std::abs(error) <= std::max(tolerance * seconds_, rest_tolerance * left)) return {};
    return last_iteration_within(left, rest);
}

int time_budget::last_iteration_within(double seconds, const forecast& rest) const {
    int least = rest.now.iteration + 1, most = static_cast<int>(options::most_iterations);
    while (least < most) {
        const int middle = least + (most - least + 1) / 2;
        if (rest.seconds_until(middle) <= seconds) {
            least = middle;
        } else {
            most = middle - 1;
        }
    }
    return least;
}

}  // namespace gs::train
