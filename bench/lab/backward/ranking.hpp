// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/gaussians.hpp"
#include "scene/scene.hpp"

namespace gs::lab {

/// The problem on which the variants of the blending are timed.
struct ranking_setup {
    gs::gaussians model;
    std::vector<gs::camera> cameras;  ///< all of one size
    std::array<float, 3> background{};
    int rounds = 7;
    std::uint64_t seed = 0;  ///< of the image's gradient
    /// Compares the accumulators of the default kernel instead of kernels. Needs `reference_fp64`.
    bool compares_accumulations = false;
    /// The sums of all Gaussians in the first views, by the same kernels in double.
    std::vector<std::vector<double>> reference_fp64;
};

/// dL/dimage: three planes.
std::vector<float> render_gradient(const ranking_setup& c);
/// Computes `ranking_setup::reference_fp64` on the CPU.
std::vector<std::vector<double>> sums_in_fp64(const ranking_setup& c);
/// So many views are compared.
std::size_t compared_views(const ranking_setup& c);

/// The result of a variant.
struct standing {
    std::string name;
    bool rung = false;                      ///< of the ladder; false for a contender
    std::vector<double> forward, backward;  ///< ms a frame, one a round
    double pairs = 0;                       ///< pixel-Gaussian pairs evaluated forward, a frame
    double apart = 0;  ///< |sums - sums of the first| / |sums of the first|, the worst frame
    double error = 0;  ///< the same against sums in double; 0 without these
};

struct ranking {
    std::string device;
    int cores = 1;  ///< of a CPU, threads
    std::vector<standing> standings;
};

ranking rank_on_cpu(const ranking_setup& c);
ranking rank_on_cuda(const ranking_setup& c);

}  // namespace gs::lab
