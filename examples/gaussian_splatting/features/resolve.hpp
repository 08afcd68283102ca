// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "feature.hpp"

namespace gs::features {

/// The value of `--effects`.
struct selection {
    enum class base {
        recommended,  ///< the features that the scene statistics recommend
        all,
        none
    };
    std::string text = "auto";
    base from = base::recommended;
    std::map<std::string, bool, std::less<>> explicit_choices;

    std::optional<bool> explicit_choice(std::string_view name) const;
    /// Returns whether the feature may be on. Masks and depth maps are read only if this is true
    /// for them.
    bool allows(std::string_view name) const;
};

/// Parses "auto", "all", "none", a list of features, or any of the first three followed by features
/// to add or remove: "auto,+exposure,-direction", or "+exposure" for short. Throws `error` for all
/// other texts.
selection parse_selection(const std::string& text);

/// The features of one training run.
class feature_set {
  public:
    feature_set() = default;
    explicit feature_set(std::vector<selected_feature> all) : all_(std::move(all)) {}

    const std::vector<selected_feature>& all() const { return all_; }
    bool is_on(std::string_view name) const;
    /// Returns the values of a feature, or an empty list if it is off.
    std::vector<float> values_if_on(std::string_view name) const;

    /// Returns whether a feature is off but may begin during training: see `feature::may_begin_half_way`.
    bool may_begin(std::string_view name) const;
    /// Returns whether a feature is on, or has begun during training.
    bool is_simulated(std::string_view name, train::engine& engine) const;

    /// Turns a feature off and records the reason. A feature that is already off keeps its reason.
    void turn_off(std::string_view name, const std::string& reason);

    /// Calls this hook of all features, or of those that are simulated. `schedule` also schedules the review
    /// of effects that may begin: see `schedule_review`.
    /// @{
    void prepare(scene& scene, gaussians& model) const;
    void schedule(train::training& training) const;
    void before_evaluation(train::engine& engine, const scene& scene) const;
    void before_saving(train::engine& engine, const scene& scene, gaussians& model) const;
    /// Returns a function that applies all simulated features to the render of a training view, or those that
    /// come before `end` in the table.
    show_function show_on_host(train::engine& engine, const scene& scene, std::string_view end = {}) const;
    void write_results(train::engine& engine, const scene& scene, const std::filesystem::path& folder) const;
    /// @}

  private:
    std::vector<selected_feature> all_;
};

/// Decides which selectable features a training simulates. Precondition: `scene` has masks and
/// depth maps if the selection allows them. `explicit_features` overrides the decision for those
/// features, as --sh-degree does. Analyzes the photos only if a decision or initial values depend
/// on them.
feature_set resolve(const scene& scene, const selection& selection,
                    const std::vector<selected_feature>& explicit_features = {});

}  // namespace gs::features
