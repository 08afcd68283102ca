// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "backend.hpp"

namespace hard_cases {

/// A crowd of faint Gaussians: a NaN that becomes the cap of alpha shows. In an image of one patch, as by
/// default, sums have one order on every device.
render_case faint_crowd(unsigned seed, std::size_t count, int width = 8, int height = 4);

/// What a Gaussian that must not be drawn did to a crowd all the same: `with` is the result with it, at
/// `index`, `rest` the one without. Images and gradients have to be equal to the bit, and its own gradients
/// zero; where `loosely`, since the order of atomics is nobody's, gradients to 1e-5 of the largest. Empty if
/// it did nothing.
std::string harm(const render_result& with, const render_result& rest, std::size_t index, bool loosely);

/// Whether a backend adds up in an order of its own from run to run, even in one patch.
bool is_loose(const backend& b, accumulator how);

}  // namespace hard_cases
