// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/parameters.hpp"
#include "raster/gradient_policy.hpp"
#include "scene/scene.hpp"

/// One picture of a few Gaussians, its loss against a photo, and the gradients of that: what the same kernels
/// give on every device and in every precision.
namespace probe {

struct question {
    int sh_degree = 3;
    std::array<std::vector<double>, gs::parameter_count> parameters;
    gs::view view;
    std::array<float, 3> background{};
    gs::gradient_policy policy = gs::gradient_policy::scatter;

    std::size_t count() const { return parameters[3].size(); }
};

struct answer {
    std::vector<double> picture;
    double loss = 0;
    std::array<std::vector<double>, gs::parameter_count> gradients;
};

/// The reference: double, one lane a warp.
answer ask_reference(const question& q);
/// The fast emulator, in float.
answer ask_lanes(const question& q);
/// The GPU, in float.
answer ask_cuda(const question& q);

}  // namespace probe
