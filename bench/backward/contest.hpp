// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/gaussians.hpp"
#include "scene/scene.hpp"

/// What the variants of the blending are timed on.
struct contest {
    gs::gaussians model;
    std::vector<gs::camera> cameras;  ///< all of one size
    std::array<float, 3> background{};
    int rounds = 7;
    std::uint64_t seed = 0;  ///< of the picture's gradient
    /// Not between kernels, but between the ways of keeping the default kernel's sums; `in_double` is filled.
    bool of_accumulations = false;
    /// Of the first views the sums of all Gaussians, by the same kernels in double.
    std::vector<std::vector<double>> in_double;
};

/// dL/dpicture: three planes.
std::vector<float> picture_gradient(const contest& c);
/// What goes to `contest::in_double`, on the CPU.
std::vector<std::vector<double>> sums_in_double(const contest& c);
/// So many views are compared.
std::size_t compared_views(const contest& c);

/// How a variant did.
struct standing {
    std::string name;
    bool rung = false;                      ///< of the ladder that the product offers, else a contender
    std::vector<double> forward, backward;  ///< ms a frame, one a round
    double pairs = 0;                       ///< pixel-Gaussian pairs evaluated forward, a frame
    double apart = 0;  ///< |sums - sums of the first| / |sums of the first|, the worst frame
    double error = 0;  ///< the same against sums in double; 0 where there are none
};

struct contest_result {
    std::string device;
    int cores = 1;  ///< of a CPU, threads
    std::vector<standing> standings;
};

contest_result hold_on_cpu(const contest& c);
contest_result hold_on_cuda(const contest& c);
