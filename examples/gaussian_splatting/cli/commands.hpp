// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "settings.hpp"

namespace gs::cli {

/// The commands. Each throws `error` for bad input and then leaves no output behind.
/// @{
void train(const settings& s);
void evaluate(const settings& s);
void render(const settings& s);
void inspect(const settings& s);
/// @}

}  // namespace gs::cli
