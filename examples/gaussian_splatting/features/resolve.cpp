// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "resolve.hpp"

#include <algorithm>
#include <sstream>

#include "../core/error.hpp"
#include "../engine/engine.hpp"
#include "half_way/review_effects.hpp"

namespace gs::features {
namespace {

std::string selectable_names() {
    std::string names;
    for (const auto& f : all_features())
        if (f->is_selectable()) names += (names.empty() ? "" : ", ") + std::string(f->name());
    return names;
}

const std::string& require_name(const std::string& name) {
    const bool exists = std::ranges::any_of(
        all_features(), [&](const auto& f) { return f->is_selectable() && f->name() == name; });
    if (!exists)
        throw error("--effects: there is no effect '" + name + "'; the effects are " + selectable_names());
    return name;
}

const selected_feature* find(const std::vector<selected_feature>& all, std::string_view name) {
    const auto found = std::ranges::find(all, name, &selected_feature::name);
    return found == all.end() ? nullptr : &*found;
}

/// Decides whether a feature is on, from the selection and the scene statistics, and sets its
/// initial values.
selected_feature decide(const feature& f, const scene_statistics& statistics, const selection& selection,
                        const std::vector<selected_feature>& earlier) {
    const bool automatic = selection.from == selection::base::recommended;
    const auto choice = selection.explicit_choice(f.name());
    selected_feature decided{std::string(f.name()), choice.value_or(selection.from == selection::base::all),
                             "--effects " + selection.text};
    if (automatic && (!choice || (*choice && f.begins_from_photos()))) {
        finding found = f.analyze(statistics);
        decided.values = std::move(found.values);
        if (!choice) {
            decided.on = found.recommended.value_or(found.if_unknown);
            decided.reason = found.evidence;
        }
    } else if (decided.on) {
        decided.values = f.neutral_values(statistics.scene());
    }
    const selected_feature* needed = find(earlier, f.needs());
    const bool lacks_needed = needed != nullptr && !needed->on;
    if (!decided.on) {
        decided.may_begin = automatic && !choice && f.may_begin_half_way() && !lacks_needed &&
                            f.obstacle(statistics.scene(), decided.values).empty();
        return decided;
    }
    if (lacks_needed && !choice) {
        decided.on = false;
        decided.reason = "the effect " + needed->name + " is off";
        return decided;
    }
    if (const std::string obstacle = f.obstacle(statistics.scene(), decided.values); !obstacle.empty()) {
        decided.on = false;
        decided.reason = obstacle;
    }
    return decided;
}

}  // namespace

std::optional<bool> selection::explicit_choice(std::string_view name) const {
    const auto found = explicit_choices.find(name);
    return found == explicit_choices.end() ? std::nullopt : std::optional(found->second);
}

bool selection::allows(std::string_view name) const {
    return explicit_choice(name).value_or(from != base::none);
}

selection parse_selection(const std::string& text) {
    selection s;
    s.text = text;
    std::istringstream words(text);
    std::string word;
    bool first = true, is_list = false;
    while (std::getline(words, word, ',')) {
        const bool has_sign = word.starts_with('+') || word.starts_with('-');
        if (first && word == "auto") {
        } else if (first && word == "all") {
            s.from = selection::base::all;
        } else if (first && word == "none") {
            s.from = selection::base::none;
        } else if (has_sign && !is_list) {
            s.explicit_choices[require_name(word.substr(1))] = word[0] == '+';
        } else if (!has_sign && (first || is_list)) {
            is_list = true;
            s.from = selection::base::none;
            s.explicit_choices[require_name(word)] = true;
        } else {
            throw error("--effects " + text + ": '" + word +
                        "' is out of place; write either a list of effects, or auto, all or none followed by "
                        "effects with + or -");
        }
        first = false;
    }
    if (first) throw error("--effects is empty: write auto, all, none, or some of " + selectable_names());
    return s;
}

bool feature_set::is_on(std::string_view name) const {
    const selected_feature* found = find(all_, name);
    return found != nullptr && found->on;
}

std::vector<float> feature_set::values_if_on(std::string_view name) const {
    const selected_feature* found = find(all_, name);
    return found != nullptr && found->on ? found->values : std::vector<float>{};
}

bool feature_set::may_begin(std::string_view name) const {
    const selected_feature* found = find(all_, name);
    return found != nullptr && found->may_begin;
}

bool feature_set::is_simulated(std::string_view name, train::engine& engine) const {
    return is_on(name) || (may_begin(name) && !engine.feature(name).values().empty());
}

void feature_set::turn_off(std::string_view name, const std::string& reason) {
    for (selected_feature& f : all_)
        if (f.name == name && f.on) f = {f.name, false, reason};
}

void feature_set::prepare(scene& scene, gaussians& model) const {
    for (const auto& f : all_features())
        if (const selected_feature* selected = find(all_, f->name())) f->prepare(*selected, scene, model);
}

void feature_set::schedule(train::training& training) const {
    schedule_review(*this, training);  // the revision of the SH degree then knows these effects
    for (const auto& f : all_features())
        if (const selected_feature* selected = find(all_, f->name())) f->schedule(*selected, training);
}

show_function feature_set::show_on_host(train::engine& engine, const scene& scene,
                                        std::string_view end) const {
    std::vector<show_function> steps;
    for (const auto& f : all_features()) {
        if (f->name() == end) break;
        if (is_simulated(f->name(), engine))
            if (show_function step = f->show_on_host(engine, scene)) steps.push_back(std::move(step));
    }
    return [steps = std::move(steps)](std::size_t view, const train::rendered_pixels& pixels,
                                      std::vector<float>& render) {
        for (const show_function& step : steps) step(view, pixels, render);
    };
}

void feature_set::before_evaluation(train::engine& engine, const scene& scene) const {
    for (const auto& f : all_features())
        if (is_simulated(f->name(), engine)) f->before_evaluation(engine, scene);
}

void feature_set::before_saving(train::engine& engine, const scene& scene, gaussians& model) const {
    for (const auto& f : all_features())
        if (is_simulated(f->name(), engine)) f->before_saving(engine, scene, model);
}

void feature_set::write_results(train::engine& engine, const scene& scene,
                                const std::filesystem::path& folder) const {
    for (const auto& f : all_features())
        if (const selected_feature* found = find(all_, f->name())) {
            selected_feature selected = *found;
            selected.on = is_simulated(f->name(), engine);
            f->write_results(selected, engine, scene, folder);
        }
}

feature_set resolve(const scene& scene, const selection& selection,
                    const std::vector<selected_feature>& explicit_features) {
    const scene_statistics statistics(scene);
    std::vector<selected_feature> all;
    for (const auto& f : all_features()) {
        if (!f->is_selectable()) continue;
        const selected_feature* fixed = find(explicit_features, f->name());
        all.push_back(fixed != nullptr ? *fixed : decide(*f, statistics, selection, all));
    }
    return feature_set(std::move(all));
}

}  // namespace gs::features
