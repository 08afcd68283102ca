// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sh_degree_feature.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "../../engine/sh_degree_state.hpp"
#include "../../training/training.hpp"
#include "../text.hpp"
#include "direction.hpp"
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

/// Saves or loads the present SH degree. If the run began with another degree than the checkpoint,
/// its options have changed, and the model gets the new degree.
void exchange_degree(state_archive& archive, int first_degree, train::training& training) {
    const state_archive::scope scope(archive, "direction");
    int saved_first = first_degree, degree = training.schedule().sh_degree;
    archive.exchange("first_degree", saved_first);
    archive.exchange("degree", degree);
    if (saved_first != first_degree) {
        degree = first_degree;
        state_of(training.engine()).set_degree(degree);
    }
    training.schedule().sh_degree = degree;
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

void sh_degree_feature::prepare(const selected_feature& selected, scene&, gaussians& model) const {
    model.sh_degree = first_sh_degree(selected.values);
    model.sh_rest.assign(model.count() * static_cast<std::size_t>(model.rest_width()), 0.0f);
}

void sh_degree_feature::schedule(const selected_feature& selected, train::training& training) const {
    const int degree = first_sh_degree(selected.values);
    training.schedule().sh_degree = degree;
    training.add_state(
        [=, &training](state_archive& archive) { exchange_degree(archive, degree, training); });
    training.result().feature_reports["direction"]["sh_degree"] = degree;
    if (selected.values.size() < 2 || selected.values[1] == 0) return;
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
    const int revise_after = schedule.bands_are_known_after();
    const auto prune_after =
        std::make_shared<int>(std::max(revise_after, training.timetable().count_is_final_after()));
    training.add({train::phase::restructure, "revise the SH degree",
                  [=](int iteration) { return iteration == revise_after; },
                  [=, &training, &schedule](int iteration) {
                      const int before = schedule.sh_degree;
                      schedule.sh_degree = revise(before);
                      state_of(training.engine()).set_degree(schedule.sh_degree);
                      auto& report = training.result().feature_reports["direction"];
                      report["on"] = schedule.sh_degree > 0;
                      report["sh_degree"] = schedule.sh_degree;
                      if (schedule.sh_degree > before)  // new coefficients need time to learn
                          *prune_after = std::max(*prune_after, iteration + schedule.sh_degree_interval);
                  }});
    if (!prune_change) return;
    training.add_state([=](state_archive& archive) {
        if (archive.loads() && !archive.has("direction.prune_after")) return;
        archive.exchange("direction.prune_after", *prune_after);
    });
    training.add({train::phase::restructure, "prune SH bands",
                  [=, &schedule](int iteration) {
                      return iteration == *prune_after && iteration < schedule.iterations;
                  },
                  [=, &training, &schedule](int) {
                      if (schedule.sh_degree == 0) return;
                      const std::size_t with_sh = state_of(training.engine()).prune(*prune_change);
                      if (with_sh < training.engine().count())
                          training.result().feature_reports["direction"]["gaussians_with_bands"] = with_sh;
                  }});
}

}  // namespace gs::features
