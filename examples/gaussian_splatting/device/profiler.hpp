// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "memory_forecast.hpp"
#include "stages.hpp"

namespace gs::device {

/// Measurements of the work that a device does.
class profiler {
  public:
    virtual ~profiler() = default;

    virtual std::string device_name() const = 0;
    /// Times every n-th step after this call. By default a CPU times each step and a GPU every 50th
    /// step, which costs little.
    virtual void sample_times(int every) = 0;
    virtual stage_times times() = 0;  ///< Returns the sums since `sample_times`, or since the start
    /// Returns the number of pairs of a pixel and a Gaussian that forward passes have evaluated.
    virtual std::uint64_t pairs() = 0;
    virtual std::size_t peak_device_bytes() const = 0;  ///< Returns zero for host memory
    virtual bool shares_host_memory() const = 0;        ///< Returns whether device memory is host memory
    virtual std::size_t used_device_bytes() const = 0;  ///< Returns the size of all buffers
    virtual std::size_t free_device_bytes() const = 0;
    /// Returns the memory that training needs with this number of Gaussians of an SH degree. New
    /// Gaussians are assumed to touch as many tiles as the present ones. Precondition:
    /// `engine::reserve` was called.
    virtual memory_forecast forecast(std::size_t gaussians, int sh_degree) const = 0;
    /// Waits until the device has finished all work.
    virtual void wait() = 0;
};

}  // namespace gs::device
