// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace gs::device {

/// The stages of an iteration, for the split of its time. Adam is the end of `project_backward`.
enum class stage { project, bin, blend_forward, loss, blend_backward, project_backward, count };

inline constexpr std::array stage_names{"project",         "bin", "blend_forward", "loss", "blend_backward",
                                        "project_backward"};

/// What decides how much memory an iteration needs: equal numbers, equal needs.
using iteration_shape = std::array<std::size_t, 6>;

/// Milliseconds per stage, summed over the `sampled` iterations that were timed.
struct stage_times {
    std::array<double, static_cast<std::size_t>(stage::count)> milliseconds{};
    int sampled = 0;
};

}  // namespace gs::device
