// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "adaptive/adaptive_config.hpp"
#include "error/error_config.hpp"
#include "mcmc/mcmc_config.hpp"
#include "timetable.hpp"

namespace gs::options {
struct option;
}

namespace gs::train {

/// The settings of a densification strategy, with the properties that the program reads on the
/// host.
template <class T>
concept strategy_config = std::copyable<T> && requires(T config, const T& set, const training_facts& facts) {
    /// The name of the strategy in --strategy.
    { T::name } -> std::convertible_to<std::string_view>;
    /// Returns the options that set members of `config`, which must outlive them. `commands`,
    /// `group` and `strategy` of a row may stay empty.
    { config.options() } -> std::same_as<std::vector<options::option>>;
    /// Throws `error` if values contradict each other or the training. Of `facts`, only
    /// `iterations` and `seed` are known, and `max_gaussians` if --max-cap is given (otherwise it
    /// is 0).
    { set.check(facts) } -> std::same_as<void>;
    /// Returns the settings with the values of dependent defaults, for settings.json.
    { set.resolved(facts) } -> std::same_as<T>;
    /// Returns the number of Gaussians that the user asks for, or nothing if the strategy decides.
    { set.target_count() } -> std::same_as<std::optional<std::size_t>>;
};

/// The name of the selected densification strategy, and the settings of all strategies.
struct strategy_settings {
    /// The settings types of all strategies. Add those of a new strategy here.
    using configs = std::tuple<adaptive_config, error_config, mcmc_config>;

    std::string name = "adaptive";
    configs all;

    template <strategy_config Config>
    Config& of() {
        return std::get<Config>(all);
    }
    template <strategy_config Config>
    const Config& of() const {
        return std::get<Config>(all);
    }

    /// Calls `visit` with the settings of each strategy.
    void for_each(auto visit) {
        std::apply([&](auto&... config) { (visit(config), ...); }, all);
    }

    /// Calls this member of the settings of the strategy called `name`: see `strategy_config`.
    /// @{
    void check(const training_facts& facts) const {
        if_chosen([&](const auto& config) { config.check(facts); });
    }
    std::optional<std::size_t> target_count() const {
        std::optional<std::size_t> count;
        if_chosen([&](const auto& config) { count = config.target_count(); });
        return count;
    }
    /// @}
    strategy_settings resolved(const training_facts& facts) const {
        strategy_settings copy = *this;
        copy.for_each([&](auto& config) { config = config.resolved(facts); });
        return copy;
    }

    static std::vector<std::string> names() {
        std::vector<std::string> all_names;
        strategy_settings().for_each([&](auto& config) { all_names.emplace_back(config.name); });
        return all_names;
    }

  private:
    void if_chosen(auto visit) const {
        std::apply([&](const auto&... config) { ((config.name == name ? visit(config) : void()), ...); },
                   all);
    }
};

}  // namespace gs::train
