// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../model/gaussians.hpp"
#include "../scene/scene_statistics.hpp"

namespace gs::train {
class engine;
class training;
}  // namespace gs::train

namespace gs::features {

/// What the training photos say about a feature.
struct finding {
    std::optional<bool> recommended;  ///< empty if the photos do not tell
    std::string evidence;             ///< the reason, with its figures
    std::string choice;               ///< what training does then, as `inspect` prints it
    std::vector<float> values{};      ///< what the feature begins from if it is on
    bool if_unknown = false;          ///< whether to simulate it if the photos do not tell
};

/// A feature in one training run.
struct selected_feature {
    std::string name;
    bool on = false;
    std::string reason;
    std::vector<float> values{};  ///< what it begins from if it is on; each feature defines its own
};

/// Changes the render of a training view: see `feature::show_on_host`.
using show_function = std::function<void(std::size_t view, std::vector<float>& render)>;

/// An effect that training simulates if the scene calls for it. This is the host's side: how the effect is
/// detected, what it begins from, when it acts, and what it writes. `device_feature.hpp` is the side that
/// takes part in a step. One object serves all runs, so a feature keeps no state here.
class feature {
  public:
    virtual ~feature() = default;

    /// The name in `--effects`, `inspect` and metrics.json.
    virtual std::string_view name() const = 0;
    /// When the effect helps and what it costs, in one sentence.
    virtual std::string_view costs_and_gains() const = 0;
    /// False for an effect that follows from the files and that `--effects` cannot name.
    virtual bool is_selectable() const { return true; }

    /// Looks at the photos. Cost: up to a second per thousand photos.
    virtual finding analyze(const scene_statistics& statistics) const = 0;
    /// Whether to `analyze` for the values to begin from even if the user has switched the effect on.
    virtual bool begins_from_photos() const { return false; }
    /// What the effect begins from if nobody looks at the photos.
    virtual std::vector<float> neutral_values(const scene&) const { return {}; }
    /// Why this scene cannot be trained with the effect on, or an empty string.
    virtual std::string obstacle(const scene&, const std::vector<float>& /*values*/) const { return {}; }

    /// Changes scene and model before training begins. Called whether the effect is on or off.
    virtual void prepare(const selected_feature&, scene&, gaussians&) const {}
    /// Adds its actions to the training loop. Called whether the effect is on or off.
    virtual void schedule(const selected_feature&, train::training&) const {}
    /// How the effect changes the render of a training view: a function of the view's index and of three
    /// planes of its size, which several threads may call. Empty if it does not change renders. Called
    /// during training, if the effect is on.
    virtual show_function show_on_host(train::engine&, const scene&) const { return {}; }
    /// Sets what held-out views are shown with. Called before they are measured, if the effect is on.
    virtual void before_evaluation(train::engine&, const scene&) const {}
    /// Writes files of its own into the output folder, or removes those of an earlier run if it is off.
    virtual void write_results(const selected_feature&, train::engine&, const scene&,
                               const std::filesystem::path& /*folder*/) const {}
};

/// All features in the order in which `inspect` prints them; table.hpp lists them.
const std::vector<std::unique_ptr<const feature>>& all_features();

}  // namespace gs::features
