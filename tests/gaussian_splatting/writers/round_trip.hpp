// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>

#include "writers/writer.hpp"

namespace gs_test {

/// The largest error of each parameter after writing and reading a model of `random_model`.
struct precision {
    double position;
    double log_scale;
    double rotation;  ///< of a component of the unit quaternion
    double opacity;   ///< from 0 to 1
    double color;     ///< of an SH coefficient of degree 0
    double sh;        ///< of an SH coefficient above
};

/// Returns a model with positions from -2 to 2, logs of scales from -6 to -1, opacities from 0.02
/// to 0.98, colors from 0 to 1 and other SH coefficients from -0.5 to 0.5, all uniform.
gs::gaussians random_model(std::size_t count, int sh_degree, unsigned seed = 1);

/// Checks that both models have the same Gaussians, in any order. Each Gaussian of `expected` is
/// compared with the one of `found` at the nearest position.
void check_same_gaussians(const gs::gaussians& expected, const gs::gaussians& found, const precision& bound);

/// Writes and reads the model.
gs::gaussians read_back(const gs::writer& format, const gs::gaussians& model,
                        const gs::write_options& options = {});

}  // namespace gs_test
