// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the rows of the option table that choose how long training is, and how large its photos are.
std::vector<options::option> length_options(settings& s);

}  // namespace gs::cli
