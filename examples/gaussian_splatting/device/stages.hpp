// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace gs::device {

/// The stages of an iteration whose times are reported separately. `project_backward` includes
/// Adam.
enum class stage { project, bin, blend_forward, loss, blend_backward, project_backward, count };

inline constexpr std::array stage_names{"project",         "bin", "blend_forward", "loss", "blend_backward",
                                        "project_backward"};

/// Determines how much memory an iteration needs: iterations of equal shapes need the same.
using iteration_shape = std::array<std::size_t, 6>;

/// Milliseconds per stage, summed over the `sampled` iterations that were timed.
struct stage_times {
    std::array<double, static_cast<std::size_t>(stage::count)> milliseconds{};
    int sampled = 0;
};

}  // namespace gs::device
