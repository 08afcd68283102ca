// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../engine/rendered_pixels.hpp"
#include "../model/gaussians.hpp"
#include "../scene/scene_statistics.hpp"
#include "explanation.hpp"
#include "finding.hpp"

namespace gs::train {
class engine;
class training;
}  // namespace gs::train

namespace gs::features {

class half_way_statistics;

/// A function that changes the render of a training view: see `feature::show_on_host`.
using show_function =
    std::function<void(std::size_t view, const train::rendered_pixels&, std::vector<float>& render)>;

/// An effect that training can simulate. This class is the host part of a feature: its detection,
/// initial values, schedule and output files. `device_feature` is the part that runs in each step.
/// One object serves all runs, so it must not keep state.
class feature {
  public:
    virtual ~feature() = default;

    /// Returns the name in `--effects`, `inspect` and metrics.json.
    virtual std::string_view name() const = 0;
    /// Returns one sentence on when the effect helps and what it costs.
    virtual std::string_view costs_and_gains() const = 0;
    /// Returns false for an effect that follows from the files, so that `--effects` cannot name it.
    virtual bool is_selectable() const { return true; }

    /// Returns the finding for a scene. Cost: up to a second per thousand photos.
    virtual finding analyze(const scene_statistics& statistics) const = 0;
    /// Returns what a person needs to believe or overrule the finding. May decode photos.
    virtual explanation explain(const scene_statistics&, const finding&) const { return {}; }
    /// Returns whether the initial values come from `analyze` even if the user adds the effect to
    /// the recommended effects.
    virtual bool begins_from_photos() const { return false; }
    /// Returns the name of an effect without which this one is never recommended, or nothing. That effect
    /// comes earlier in the table.
    virtual std::string_view needs() const { return {}; }
    /// Returns whether training may begin the effect half-way if `analyze` has not recommended it. Such an
    /// effect has a part on the device, whose values are empty while it is off.
    virtual bool may_begin_half_way() const { return false; }
    /// Returns the finding from the differences between photos and a half-trained model. Called if the effect
    /// `may_begin_half_way`. Cost: a few seconds.
    virtual finding review(const half_way_statistics&) const { return {}; }
    /// Returns the initial values if `analyze` is not called.
    virtual std::vector<float> neutral_values(const scene&) const { return {}; }
    /// Returns the reason why this scene cannot be trained with the effect on, or an empty string.
    virtual std::string obstacle(const scene&, const std::vector<float>& /*values*/) const { return {}; }

    /// Changes scene and model before training begins. Called whether the effect is on or off.
    virtual void prepare(const selected_feature&, scene&, gaussians&) const {}
    /// Adds its actions to the training loop. Called whether the effect is on or off.
    virtual void schedule(const selected_feature&, train::training&) const {}
    /// Returns a function that applies the effect to the render of a training view, or an empty
    /// function if it changes no renders. The function takes the view's index and three planes of its
    /// size or of a smaller size, with the pixels that `rendered_pixels` describe; several threads may call
    /// it. Called during training if the effect is on.
    virtual show_function show_on_host(train::engine&, const scene&) const { return {}; }
    /// Sets the effect's values for held-out views. Called before they are measured, if the effect
    /// is on.
    virtual void before_evaluation(train::engine&, const scene&) const {}
    /// Changes the model that is written to a file, which lacks the effect, so that it looks like the photos.
    /// Called if the effect is on.
    virtual void before_saving(train::engine&, const scene&, gaussians&) const {}
    /// Writes the effect's files to the output folder. If it is off, removes those of an earlier
    /// run.
    virtual void write_results(const selected_feature&, train::engine&, const scene&,
                               const std::filesystem::path& /*folder*/) const {}
};

/// Returns all features of table.hpp, in the order in which `inspect` prints them.
const std::vector<std::unique_ptr<const feature>>& all_features();

}  // namespace gs::features
