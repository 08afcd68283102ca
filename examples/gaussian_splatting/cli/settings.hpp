// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "../densify/strategy_settings.hpp"
#include "../features/simulate.hpp"
#include "../readers/load_scene.hpp"
#include "../training/schedule.hpp"

namespace gs::cli {

/// What the command line says, as it says it.
struct settings {
    std::string command;  ///< "train", "evaluate", "render" or "inspect"
    load_options scene;
    std::string output;
    std::string ply;
    std::string device = "auto";
    std::string background = "auto";
    std::uint64_t seed = 0;
    bool quiet = false;

    effects::selection effects;
    std::optional<int> sh_degree;  ///< none: by `effects`
    bool fit_exposure = false;
    std::string quality = "balanced";
    train::schedule schedule;
    train::strategy_settings densification;
    std::size_t max_cap = 0;  ///< 0: by the photos
    bool deterministic = false;
    std::set<int> save_iterations;
    std::set<int> test_iterations;

    int orbit_views = 8;
};

/// Parses and checks the command line. Exits for --help; throws `error` for what is wrong with it, in one
/// sentence.
settings parse(int argc, char** argv);

void train(const settings& settings);
void evaluate(const settings& settings);
void render(const settings& settings);
void inspect(const settings& settings);

}  // namespace gs::cli
