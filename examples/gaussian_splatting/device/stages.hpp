// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace gs::device {

/// The stages of an iteration whose times are reported separately. `project_backward` includes
/// Adam.
enum class stage { project, bin, blend_forward, loss, blend_backward, project_backward, count };

inline constexpr std::array stage_names{"project",         "bin", "blend_forward", "loss", "blend_backward",
                                        "project_backward"};

/// The values that determine the launches and the memory of an iteration. Iterations with equal
/// keys launch the same kernels over the same ranges and use the same memory.
using graph_key = std::vector<std::size_t>;

/// Milliseconds per stage, summed over the `sampled` iterations that were timed.
struct stage_times {
    std::array<double, static_cast<std::size_t>(stage::count)> milliseconds{};
    int sampled = 0;
};

}  // namespace gs::device
