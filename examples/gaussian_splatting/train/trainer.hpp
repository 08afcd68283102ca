// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <set>
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
    int iterations = 7000;
    int sh_degree = 3;
    int sh_degree_interval = 1000;
    float densify_gradient = densify_rule{}.gradient;
    std::size_t max_cap = 0;  ///< most Gaussians
    std::uint64_t seed = 0;
    gradient_policy gradient = gradient_policy::scatter;
    background_choice background;
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
};

/// What the loop calls back for.
struct train_events {
    std::function<void(const progress&)> report;
    std::function<void(int iteration)> save;
    std::function<void(int iteration)> test;
};

/// Trains what `engine` holds. Precondition: `engine` has the scene's views and a model.
train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events);

/// As many Gaussians as the photos can tell apart: one for 32 pixels of all training views together, and no
/// fewer than 10,000.
std::size_t default_cap(const scene& scene);

}  // namespace gs::train
