// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "../device/profiler.hpp"
#include "../optimize/parameter_storage.hpp"
#include "../photos/photo_plan.hpp"
#include "../ranks/transport.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the limits of --photo-memory, or shares of the available memory. Photos are the same
/// wherever they are, so the limits do not change results. The ranks of a machine share its memory.
photos::photo_limits photo_limits(const settings& s, const device::profiler& device,
                                  const ranks::place& place);

/// Returns the limit of --gpu-memory, or a share of the available memory. Returns 0, which means no
/// limit, for --deterministic without --gpu-memory: the result must not depend on the machine.
std::uint64_t device_limit(const settings& s, const device::profiler& device, const ranks::place& place);

/// Returns the scene to load, whose photos stay in their files if they exceed the limits.
load_options with_limit(load_options source, const photos::photo_limits& limits);

/// Returns the memory for photos: empty if they are resident.
photos::photo_plan photo_memory(const scene& of, const photos::photo_limits& limits, std::size_t at_once);

/// Returns the precision of moments: `wanted` if it is set, and otherwise compact if the forecast for float
/// moments exceeds the limit. A limit of 0 means none.
train::moment_precision precision_for(std::optional<train::moment_precision> wanted,
                                      const device::memory_forecast& with_floats, std::uint64_t limit);

/// A model, and the memory for it.
struct model_memory {
    std::size_t gaussians = 0;
    int sh_degree = 0;
    device::memory_forecast forecast;  ///< with float moments, and nothing in host memory
    std::uint64_t device_limit = 0;    ///< see `device_limit`
    std::uint64_t host_limit = 0;      ///< see `parameter_bytes_on_host`
};

/// Returns the storage with as few SH degrees in host memory as the limit of the device permits. If it
/// permits none, returns the one with as many as the host has room for.
train::parameter_storage storage_for(const model_memory& model, train::moment_precision precision);

/// Returns the host memory for parameters: a share of what is available, or none if the device shares the
/// host's memory or if there are several ranks.
std::uint64_t parameter_bytes_on_host(const device::profiler& device, const ranks::place& place);

/// Returns a line for the user about the expected memory with `most` Gaussians. `photos_on_host`: see below.
std::string expected_memory(const device::memory_forecast& forecast, std::size_t most,
                            std::uint64_t photos_on_host);

/// Returns the size of the photos in host memory.
std::uint64_t photos_on_host(const scene& of, const photos::photo_plan& plan);

}  // namespace gs::cli
