// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

namespace gs {

/// Returns how many bytes of host memory programs can still allocate without swapping, as Linux
/// estimates it. Returns the largest number if Linux does not tell.
inline std::uint64_t available_host_bytes() {
    std::ifstream lines("/proc/meminfo");
    for (std::string name, unit; lines >> name;) {
        std::uint64_t kibibytes = 0;
        if (name == "MemAvailable:" && lines >> kibibytes) return 1024 * kibibytes;
        std::getline(lines, unit);
    }
    return std::numeric_limits<std::uint64_t>::max();
}

}  // namespace gs
