// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../scene/scene.hpp"

namespace gs::effects {

/// What a training can simulate or leave. docs/effects.md says what another one needs.
enum class effect { direction, exposure, antialiasing, sky, masks, depth, count };

inline constexpr std::array<std::string_view, static_cast<std::size_t>(effect::count)> effect_names{
    "direction", "exposure", "antialiasing", "sky", "masks", "depth"};

/// What --effects says.
struct selection {
    enum class base {
        found,  ///< what the scene calls for
        all,
        none
    };
    std::string text = "auto";  ///< as it was said
    base from = base::found;
    std::array<std::optional<bool>, effect_names.size()> said;  ///< of single effects

    const std::optional<bool>& of(effect e) const { return said[static_cast<std::size_t>(e)]; }
    /// Whether an effect is not ruled out: whether masks or depth maps are to be read, if there are any.
    bool takes(effect e) const { return of(e).value_or(from != base::none); }
};

/// From "auto", "all", "none", a list of effects, or any of the first three with what is to be added or left
/// out: "auto,+exposure,-direction", or "+exposure" for short. Throws `error` for what is none of these.
selection parse_selection(const std::string& text);

/// What training simulates.
struct simulation {
    struct outcome {
        std::string name;
        bool on;
        std::string reason;
    };

    int sh_degree = 0;
    bool reviews_bands = false;  ///< in training: nobody has said which degree
    bool antialiasing = false;
    /// By training photo, how much brighter than others it has the same points, as a factor; ones where
    /// nobody has looked, and none without the effect.
    std::vector<float> exposures;
    /// What it begins from, see `gaussians::sky`: zeros where nobody has looked, and none without the effect.
    std::vector<float> sky;
    /// Of the training photos' depth maps; without a scale where they do not agree with the points. None
    /// without the effect.
    std::vector<depth_fit> depth_fits;
    std::vector<outcome> outcomes;  ///< one an effect

    /// Whatever was decided: for this reason.
    void leave_out(effect e, const std::string& reason);
};

/// `scene`: with masks and depth maps if they are to be taken. `sh_degree`: the one that was said. Looks at
/// the photos only if something depends on them.
simulation simulate(const scene& scene, const selection& selection, const std::optional<int>& sh_degree);

}  // namespace gs::effects
