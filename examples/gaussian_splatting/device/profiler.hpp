// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "stages.hpp"

namespace gs::device {

/// What a device can tell about the work it does.
class profiler {
  public:
    virtual ~profiler() = default;

    virtual std::string device_name() const = 0;
    /// Times every n-th step from now on. By default, the steps that cost nothing to time: all on the CPU,
    /// every 50th on a GPU.
    virtual void sample_times(int every) = 0;
    virtual stage_times times() = 0;  ///< since `sample_times`, or since the start
    /// Pairs of pixel and Gaussian that steps have evaluated in the forward pass.
    virtual std::uint64_t pairs() = 0;
    virtual std::size_t peak_device_bytes() const = 0;  ///< zero if the device uses the host's memory
    /// Waits until the device has done all its work.
    virtual void wait() = 0;
};

}  // namespace gs::device
