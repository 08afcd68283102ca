// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the rows of the option table that limit memory.
std::vector<options::option> memory_options(settings& s);

}  // namespace gs::cli
