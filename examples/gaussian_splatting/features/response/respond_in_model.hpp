// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../model/gaussians.hpp"

namespace gs::features {

/// Changes the colors of a model, and those of its sky, to those that a response with these increments
/// shows: `response_width` values. Files of models have no response. The colors of each Gaussian become a
/// linear approximation of the response around its constant color. Beyond [0, 1], the curve goes on as a
/// line, so that colors keep their differences.
void respond_in_model(const float* increments, gaussians& model);

}  // namespace gs::features
