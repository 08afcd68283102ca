// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

namespace gs {

/// Returns how many bytes the memory limit of this container leaves, or the largest number without a
/// limit.
inline std::uint64_t bytes_left_in_container() {
    std::uint64_t most = 0, used = 0;
    const bool is_limited = static_cast<bool>(std::ifstream("/sys/fs/cgroup/memory.max") >> most) &&
                            static_cast<bool>(std::ifstream("/sys/fs/cgroup/memory.current") >> used);
    if (!is_limited) return std::numeric_limits<std::uint64_t>::max();
    return most > used ? most - used : 0;
}

/// Returns how many bytes of host memory programs can still allocate without swapping, as Linux
/// estimates it. Returns the largest number if Linux does not tell.
inline std::uint64_t available_host_bytes() {
    std::ifstream lines("/proc/meminfo");
    for (std::string name, unit; lines >> name;) {
        std::uint64_t kibibytes = 0;
        if (name == "MemAvailable:" && lines >> kibibytes)
            return std::min(1024 * kibibytes, bytes_left_in_container());
        std::getline(lines, unit);
    }
    return bytes_left_in_container();
}

}  // namespace gs
