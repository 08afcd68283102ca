// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine.hpp"
#include "schedule.hpp"

namespace gs::train {

/// What to learn from each photo's transparent parts.
struct background_choice {
    std::array<float, 3> colour{};
    bool random = false;  ///< another one every iteration; `colour` is what tests are shown on
};

struct train_options {
    train::schedule schedule;  ///< but for what the scene says: extent and white
    std::size_t max_cap = 0;   ///< most Gaussians
    /// Gaussians to grow to, evenly and whatever their gradients; 0: as many as have the gradient.
    std::size_t budget = 0;
    bool revised_opacity = true;  ///< see `densify_rule`
    std::uint64_t seed = 0;
    accumulator gradient = accumulator::native;
    std::string loss = default_loss;  ///< a name in the table `losses`
    background_choice background;
    /// Of the training photos, to begin from; none: photos are as the scene is. See exposure_kernels.hpp.
    std::vector<train::exposure> exposures;
    std::vector<depth_fit> depth_fits;  ///< of the training photos' depth maps, if these are learnt from
    /// Asked half-way, with the degree so far, up to which colours are to depend on direction from then on;
    /// may be none, and the schedule's stays.
    std::function<int(int sh_degree)> review_bands;
    /// By what training views may change when Gaussians whose colours hardly depend on direction lose their
    /// bands, see `engine::drop_bands`; none: they do not. That is when there are no new ones any more, and
    /// bands have been reviewed and have had their time.
    std::optional<double> band_change;
    std::set<int> save_iterations;
    std::set<int> test_iterations;
};

/// Where training stands.
struct progress {
    int iteration = 0, iterations = 0;
    double loss = 0, psnr = 0;  ///< of the training photos, lately
    std::size_t gaussians = 0;
    double seconds = 0;
};

struct train_result {
    double seconds = 0;          ///< in the loop
    double densify_seconds = 0;  ///< of these, for densification and for sizing the lists
    std::uint64_t skipped_steps = 0;
    std::uint64_t left_out_gradients = 0;  ///< elements that were not finite
    std::uint64_t left_out_sums = 0;       ///< steps where one did not fit in fixed point
    std::uint64_t silent_gaussians = 0;    ///< the most at any densification: see `engine::densify`
    int sh_degree = 0;                     ///< up to which colours depend on direction in the end
    std::optional<std::size_t> banded;     ///< Gaussians whose colours do, where others have no bands
    std::vector<exposure> exposures;       ///< of the training photos, if they have any
};

/// What the loop calls back for.
struct train_events {
    std::function<void(const progress&)> report;  ///< before a test, too
    std::function<void(int iteration)> save;
    std::function<void(int iteration)> test;
    std::function<void(const std::string&)> warn = [](const std::string&) {};
};

/// Trains what `engine` holds. Precondition: `engine` has the scene's views and a model.
/// The device notes what is not finite in the iteration where it appears; that is looked at every 100
/// iterations and before anything is tested or saved. An element of a gradient that is not finite is left out
/// of its step, and a warning names the first. A loss that is not finite, or a parameter that would not be,
/// ends training: throws `error` naming iteration and view, and which parameter of which Gaussian; what was
/// saved before stays.
train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events);

/// As many Gaussians as the photos can tell apart: one for 32 pixels of all training views together, and no
/// fewer than 10,000.
std::size_t default_cap(const scene& scene);

}  // namespace gs::train
