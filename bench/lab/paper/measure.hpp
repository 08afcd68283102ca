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

/// The problem on which kernels of the backward blending are measured.
struct paper_subject {
    gs::gaussians model;
    std::vector<gs::camera> cameras;
    std::array<float, 3> background{};
    int rounds = 7;
    std::uint64_t seed = 0;  ///< of the image's gradient
};

/// A kernel's time; the first one's is what others are compared to.
struct paper_kernel {
    std::string name;
    std::vector<double> milliseconds;  ///< a frame, one a round
    double apart = 0;  ///< |sums - sums of the first| / |sums of the first|, in the first view
};

/// (warp of 32 lanes, Gaussian) pairs of one pass over the views, by the lanes that have a gradient to add.
struct active_lanes {
    std::array<unsigned long long, 33> warps{};  ///< [0]: came to the adding, but none had
    unsigned long long listed = 0;               ///< warps of a tile times the length of its list
};

struct paper_figures {
    std::string device;
    unsigned lanes = 0;  ///< of the warps that were timed
    std::vector<paper_kernel> kernels;
    active_lanes active;
};

paper_figures measure_on_cpu(const paper_subject& s);
paper_figures measure_on_cuda(const paper_subject& s);

}  // namespace gs::lab
