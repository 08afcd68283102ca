// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the rows of the option table about the live view.
std::vector<options::option> view_options(settings& s);
/// Returns the rows about orbits and camera paths of render.
std::vector<options::option> video_options(settings& s);

}  // namespace gs::cli
