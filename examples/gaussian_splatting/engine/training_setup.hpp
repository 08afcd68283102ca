// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "../densify/strategy_settings.hpp"
#include "../densify/timetable.hpp"
#include "../losses/loss.hpp"
#include "../optimize/parameter_storage.hpp"
#include "../render/gradients/accumulator.hpp"
#include "step_plan.hpp"

namespace gs::train {

/// The settings that stay the same during a training run.
struct training_setup {
    training_facts facts;
    strategy_settings densification;
    std::string loss = default_loss;
    parameter_storage storage{};
    /// Host memory for parameters that `facts.max_device_bytes` has no room for.
    std::uint64_t host_bytes = 0;
    double dropout = 0;          ///< share of the Gaussians that each step leaves out: see `raster::dropout`
    std::size_t batch_size = 1;  ///< number of views of each step
    /// The features that are on, by name, with their initial values.
    std::map<std::string, std::vector<float>, std::less<>> features;

    bool has(std::string_view feature) const { return features.contains(feature); }
};

}  // namespace gs::train
