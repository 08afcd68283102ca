// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// What this process has a GPU do from its making on, as CUPTI records it. One at a time.
class gpu_trace {
  public:
    /// How often something was done, and for how many nanoseconds in all.
    struct total {
        std::uint64_t count = 0, nanoseconds = 0;
    };
    struct result {
        std::map<std::string, total> work;   ///< of the GPU, by kernel, "memcpy" and "memset"
        std::map<std::string, total> calls;  ///< of the host, by function of the CUDA runtime
        std::map<std::string, total> waits;  ///< time that the host waited for the GPU, by cause
        std::uint64_t allocations = 0;       ///< of the GPU's memory, and releases
        std::uint64_t busy = 0,
                      wall = 0;  ///< ns: some work runs; from the first work's start to the last one's end
    };

    gpu_trace();
    gpu_trace(const gpu_trace&) = delete;
    gpu_trace& operator=(const gpu_trace&) = delete;
    /// Ends the recording. The GPU must be idle.
    result stop();
    ~gpu_trace();
};
