// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "settings.hpp"

namespace gs::cli {

/// Sets the members that follow from options of other names.
void set_dependent_values(settings& s);

/// Throws `error` for options whose values contradict each other.
void check_settings(const settings& s);

}  // namespace gs::cli
