// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "../densify/strategy_settings.hpp"
#include "../features/resolve.hpp"
#include "../losses/loss.hpp"
#include "../options/command.hpp"
#include "../options/enum_names.hpp"
#include "../readers/load_scene.hpp"
#include "../training/schedule.hpp"

namespace gs::cli {

using options::all_values;
using options::command;
using options::name_of;

enum class device_kind { automatic, cpu, cuda };
enum class background_kind { automatic, white, black, random };
enum class quality_preset { fast, balanced, best };

/// Returns the words of the command line for an enumeration, in the order of its values.
/// @{
constexpr std::array<std::string_view, 3> names_of(device_kind) { return {"auto", "cpu", "cuda"}; }
constexpr std::array<std::string_view, 4> names_of(background_kind) {
    return {"auto", "white", "black", "random"};
}
constexpr std::array<std::string_view, 3> names_of(quality_preset) { return {"fast", "balanced", "best"}; }
/// @}

/// The values of all options. The table in option_table.cpp sets them from the command line.
struct settings {
    cli::command command = command::train;
    load_options scene;
    std::string output;
    std::string ply;
    device_kind device = device_kind::automatic;
    background_kind background = background_kind::automatic;
    std::uint64_t seed = 0;
    bool deterministic = false;
    bool quiet = false;

    quality_preset quality = quality_preset::balanced;
    train::schedule schedule;
    train::strategy_settings densification;
    std::string loss = train::default_loss;
    features::selection effects;
    std::optional<int> sh_degree;        ///< if unset, `effects` decides
    std::optional<std::size_t> max_cap;  ///< if unset, the size of the photos decides
    bool fit_exposure = false;
    std::string lpips;  ///< file of weights; if empty, LPIPS is not computed
    std::set<int> save_iterations;
    std::set<int> test_iterations;

    int orbit_views = 8;
};

}  // namespace gs::cli
