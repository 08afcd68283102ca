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
#include "../readers/load_scene.hpp"
#include "../training/schedule.hpp"

namespace gs::cli {

enum class command { train, evaluate, render, inspect };
enum class device_kind { automatic, cpu, cuda };
enum class background_kind { automatic, white, black, random };
enum class quality_preset { fast, balanced, best };

/// The words of the command line for the values of an enumeration, in the order of its values.
/// @{
constexpr std::array<std::string_view, 4> names_of(command) {
    return {"train", "evaluate", "render", "inspect"};
}
constexpr std::array<std::string_view, 3> names_of(device_kind) { return {"auto", "cpu", "cuda"}; }
constexpr std::array<std::string_view, 4> names_of(background_kind) {
    return {"auto", "white", "black", "random"};
}
constexpr std::array<std::string_view, 3> names_of(quality_preset) { return {"fast", "balanced", "best"}; }
/// @}

template <class Enum>
std::string name_of(Enum value) {
    return std::string(names_of(value)[static_cast<std::size_t>(value)]);
}

/// All values of an enumeration, in their order.
template <class Enum>
inline constexpr auto all_values = [] {
    std::array<Enum, names_of(Enum{}).size()> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Enum>(i);
    return values;
}();

/// The values of all options. options.cpp has the table that fills it from the command line.
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
    features::selection effects;
    std::optional<int> sh_degree;        ///< unset: chosen by `effects`
    std::optional<std::size_t> max_cap;  ///< unset: chosen by the size of the photos
    std::optional<std::size_t> budget;   ///< unset: densification follows the gradients
    bool fit_exposure = false;
    std::set<int> save_iterations;
    std::set<int> test_iterations;

    int orbit_views = 8;
};

}  // namespace gs::cli
