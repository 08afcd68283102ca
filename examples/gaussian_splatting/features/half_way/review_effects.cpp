// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "review_effects.hpp"

#include <string>
#include <vector>

#include "../../ranks/communicator.hpp"
#include "../../training/training.hpp"
#include "half_way_statistics.hpp"

namespace gs::features {
namespace {

/// Gives all ranks the finding of the first one, so that they begin the same effects with the same values.
void share(finding& found, ranks::communicator* ranks) {
    if (ranks == nullptr) return;
    found.recommended = ranks->from_first(found.recommended.value_or(false) ? 1 : 0) != 0;
    for (float& value : found.values)
        value = static_cast<float>(ranks->from_first(static_cast<double>(value)));
}

/// Reviews an effect, begins it if it is recommended, and reports the decision.
void review(const feature& f, const half_way_statistics& statistics, train::training& training,
            int iteration) {
    const std::string name(f.name());
    finding found = f.review(statistics);
    share(found, training.options().ranks);
    const bool begins = found.recommended.value_or(false);
    if (begins) training.engine().feature(name).set_values(found.values);
    auto& report = training.result().feature_reports[name];
    report["on"] = begins;
    report["on_at_first"] = false;
    report["reason_half_way"] = found.evidence;
    training.say(name + (begins ? " on after iteration " : " still off after iteration ") +
                 std::to_string(iteration) + ": " + found.evidence);
}

void review_all(const std::vector<const feature*>& reviewed, const feature_set& features,
                train::training& training, int iteration) {
    train::engine& engine = training.engine();
    const scene& scene = training.scene();
    std::vector<const feature*> off;
    for (const feature* f : reviewed)
        if (!features.is_simulated(f->name(), engine)) off.push_back(f);
    if (off.empty()) return;
    engine.ranks().prepare_renders();
    // The fits have unknown exposures of their own, which a response follows.
    const half_way_statistics statistics(
        scene, compare_with_photos(engine, scene, features.show_on_host(engine, scene, "exposure"),
                                   training.options().background.color));
    for (const feature* f : off) review(*f, statistics, training, iteration);
}

/// Saves whether the effect has begun half-way, or begins it as the checkpoint says.
void exchange_beginning(const feature& f, const feature_set& features, train::training& training,
                        state_archive& archive) {
    const std::string name(f.name()), key = name + ".begun_half_way";
    train::engine& engine = training.engine();
    const bool may_begin = features.may_begin(name);
    if (!archive.loads()) {
        bool begun = may_begin && features.is_simulated(name, engine);
        if (may_begin) archive.exchange(key, begun);
        return;
    }
    bool begun = false;
    if (archive.has(key)) archive.exchange(key, begun);
    if (!may_begin)
        training.result().feature_reports.erase(name);
    else if (begun)
        engine.feature(name).set_values(f.neutral_values(training.scene()));
}

}  // namespace

void schedule_review(const feature_set& features, train::training& training) {
    std::vector<const feature*> reviewed;
    for (const auto& f : all_features()) {
        if (!f->may_begin_half_way()) continue;
        training.add_state_before_engine([&features, &training, f = f.get()](state_archive& archive) {
            exchange_beginning(*f, features, training, archive);
        });
        if (features.may_begin(f->name())) reviewed.push_back(f.get());
    }
    if (reviewed.empty()) return;
    const train::schedule& schedule = training.schedule();
    training.add({train::phase::restructure, "review effects",
                  [&schedule](int iteration) { return iteration == schedule.iterations.milestone(0.5); },
                  [&features, &training, reviewed](int iteration) {
                      review_all(reviewed, features, training, iteration);
                  }});
}

}  // namespace gs::features
