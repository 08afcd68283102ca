// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "../engine/engine.hpp"
#include "../ranks/communicator.hpp"
#include "../render/gradients/accumulator.hpp"
#include "settings.hpp"

namespace gs::cli {

/// The commands. They throw `error` for bad input, and then leave no output behind.
/// @{
void train(const settings& s);
/// Trains with this engine and accumulator, regardless of the device and the determinism in `s`, as
/// one of the ranks. Only the first rank prints, and writes files other than renders.
void train(const settings& s, std::unique_ptr<train::engine> engine, accumulator gradient,
           ranks::communicator& ranks);
void evaluate(const settings& s);
void render(const settings& s);
void compare(const settings& s);
void convert(const settings& s);
void view_model(const settings& s);
void inspect(const settings& s);
void doctor();
/// @}

}  // namespace gs::cli
