// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "../device/profiler.hpp"
#include "../photos/photo_plan.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the limits of --photo-memory, or shares of the available memory. Photos are the same
/// wherever they are, so the limits do not change results. The ranks share the host's memory.
photos::photo_limits photo_limits(const settings& s, const device::profiler& device, int ranks);

/// Returns the limit of --max-memory, or a share of the available memory. Returns 0, which means no
/// limit, for --deterministic without --max-memory: the result must not depend on the machine.
std::uint64_t device_limit(const settings& s, const device::profiler& device, int ranks);

/// Returns the scene to load, whose photos stay in their files if they exceed the limits.
load_options with_limit(load_options source, const photos::photo_limits& limits);

/// Returns the memory for photos: empty if they are resident.
photos::photo_plan photo_memory(const scene& of, const photos::photo_limits& limits);

/// Returns --precision. If it is unset: compact if the forecast for float moments exceeds the limit. A
/// limit of 0 means none.
train::moment_precision precision_for(const settings& s, const device::memory_forecast& with_floats,
                                      std::uint64_t limit);

/// Returns a line for the user about the expected memory with `most` Gaussians.
std::string expected_memory(const device::memory_forecast& forecast, std::size_t most, std::uint64_t on_host);

/// Returns the size of the photos in host memory.
std::uint64_t photos_on_host(const scene& of, const photos::photo_plan& plan);

}  // namespace gs::cli
