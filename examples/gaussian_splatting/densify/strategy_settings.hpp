// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "adaptive/adaptive_config.hpp"

namespace gs::train {

/// The name of a densification strategy (see strategies.hpp) and the settings of each one.
struct strategy_settings {
    std::string name = "adaptive";
    adaptive_config adaptive{};
};

}  // namespace gs::train
