// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sh_degree_feature.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "../../core/error.hpp"
#include "../../engine/sh_degree_state.hpp"
#include "../../training/training.hpp"
#include "../text.hpp"
#include "direction.hpp"
#include "direction_explanation.hpp"
#include "revise_sh_degree.hpp"

namespace gs::features {
namespace {

train::sh_degree_state& state_of(train::engine& engine) {
    return dynamic_cast<train::sh_degree_state&>(engine.feature("direction"));
}

/// Determines the SH degree from the difference between photos and renders, and reports the
/// figures.
int revise(train::training& training, int sh_degree) {
    const train::train_options& options = training.options();
    const sh_review review =
        revise_sh_degree(training.engine(), training.scene(),
                         options.features.show_on_host(training.engine(), training.scene()),
                         options.background.color, sh_degree);
    auto& report = training.result().feature_reports["direction"];
    report["sh_degree_at_first"] = sh_degree;
    report["unexplained_half_way"] = review.unexplained;
    if (review.change) report["change_without_highest_band"] = *review.change;
    return review.sh_degree;
}

/// Saves or loads the present SH degree. With --sh-degree, a loaded model gets that degree.
void exchange_degree(state_archive& archive, std::optional<int> explicit_degree, train::training& training) {
    int degree = training.schedule().sh_degree;
    archive.exchange("direction.degree", degree);
    if (!archive.loads()) return;
    if (degree < 0 || degree > 3) throw error("the checkpoint has the SH degree " + std::to_string(degree));
    training.schedule().sh_degree = explicit_degree.value_or(degree);
    state_of(training.engine()).set_degree(training.schedule().sh_degree);
    training.result().feature_reports["direction"]["sh_degree"] = training.schedule().sh_degree;
}

}  // namespace

finding sh_degree_feature::analyze(const scene_statistics& statistics) const {
    const direction_statistics found = measure_direction(statistics);
    const int degree = found.degree();
    const std::string choice = "--sh-degree " + std::to_string(degree);
    std::vector<float> values{static_cast<float>(degree), 1};
    if (!found.is_known())
        return {{},
                too_few_points(found.points, "of similar size in smooth areas"),
                choice,
                std::move(values),
                degree > 0};
    const auto up_to = static_cast<std::size_t>(degree == 0 ? 3 : degree);
    return {
        degree > 0,
        text(
            "degree %zu reduces the unexplained difference between photos of a point from %.2f %% to %.2f %%",
            up_to, 100 * std::sqrt(found.unexplained[0]), 100 * std::sqrt(found.unexplained[up_to])),
        choice, std::move(values)};
}

explanation sh_degree_feature::explain(const scene_statistics& statistics, const finding& found) const {
    const int degree = first_sh_degree(found.values);
    explanation made = explain_direction(statistics, degree == 0 ? 3 : degree);
    for (int other = 0; other <= 3; ++other)
        if (other != degree) made.options.push_back("--sh-degree " + std::to_string(other));
    return made;
}

void sh_degree_feature::prepare(const selected_feature& selected, scene&, gaussians& model) const {
    model.sh_degree = first_sh_degree(selected.values);
    model.sh_rest = {};  // zero: see `train::engine::set_model`
}

void sh_degree_feature::schedule(const selected_feature& selected, train::training& training) const {
    const int degree = first_sh_degree(selected.values);
    training.schedule().sh_degree = degree;
    const bool revises = selected.values.size() > 1 && selected.values[1] != 0;
    const std::optional<int> explicit_degree = revises ? std::nullopt : std::optional(degree);
    training.add_state(
        [=, &training](state_archive& archive) { exchange_degree(archive, explicit_degree, training); });
    training.result().feature_reports["direction"]["sh_degree"] = degree;
    if (!revises) return;
    schedule_revision(
        training, [&training](int so_far) { return revise(training, so_far); }, prune_change_limit);
}

selected_feature explicit_sh_degree(int degree) {
    return {
        "direction", degree > 0, "--sh-degree " + std::to_string(degree), {static_cast<float>(degree), 0}};
}

int first_sh_degree(const std::vector<float>& values) {
    return values.empty() ? 0 : static_cast<int>(values[0]);
}

void schedule_revision(train::training& training, std::function<int(int sh_degree)> revise,
                       std::optional<double> prune_change) {
    train::schedule& schedule = training.schedule();
    const auto revise_after = [&schedule, first_degree = schedule.sh_degree] {
        return schedule.bands_are_known_after(first_degree);
    };
    const auto earliest_prune = std::make_shared<int>(0);
    const auto prune_after = [=, &training] {
        return std::max({*earliest_prune, revise_after(), training.timetable().count_is_final_after()});
    };
    training.add({train::phase::restructure, "revise the SH degree",
                  [=](int iteration) { return iteration == revise_after(); },
                  [=, &training, &schedule](int iteration) {
                      const int before = schedule.sh_degree;
                      schedule.sh_degree = revise(before);
                      state_of(training.engine()).set_degree(schedule.sh_degree);
                      auto& report = training.result().feature_reports["direction"];
                      report["on"] = schedule.sh_degree > 0;
                      report["sh_degree"] = schedule.sh_degree;
                      if (schedule.sh_degree != before)
                          training.say("direction: SH degree " + std::to_string(schedule.sh_degree) +
                                       " instead of " + std::to_string(before) + " after iteration " +
                                       std::to_string(iteration));
                      if (schedule.sh_degree > before)  // new coefficients need time to learn
                          *earliest_prune = iteration + schedule.sh_degree_interval;
                  }});
    if (!prune_change) return;
    training.add_state([=, &training](state_archive& archive) {
        if (archive.loads() && !archive.has("direction.prune_after")) return;
        int saved = *earliest_prune, iteration = 0;
        archive.exchange("direction.prune_after", saved);
        if (!archive.loads()) return;
        // More iterations can delay it; then the coefficients of the report exist again.
        *earliest_prune = std::max(*earliest_prune, saved);
        archive.exchange("training.iteration", iteration);
        if (prune_after() > iteration)
            training.result().feature_reports["direction"].erase("gaussians_with_bands");
    });
    training.add({train::phase::restructure, "prune SH bands",
                  [=, &schedule](int iteration) {
                      return iteration == prune_after() && iteration < schedule.iterations.last();
                  },
                  [=, &training, &schedule](int) {
                      if (schedule.sh_degree == 0) return;
                      const std::size_t with_sh = state_of(training.engine()).prune(*prune_change);
                      if (with_sh < training.engine().count())
                          training.result().feature_reports["direction"]["gaussians_with_bands"] = with_sh;
                  }});
}

}  // namespace gs::features
