// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <string>

/// Returns the version of the GPU's driver, the first word with a dot in its description, or an empty
/// string without a driver.
inline std::string driver_version() {
    std::ifstream about("/proc/driver/nvidia/version");
    std::string word;
    while (about >> word)
        if (word.find('.') != std::string::npos) return word;
    return "";
}
