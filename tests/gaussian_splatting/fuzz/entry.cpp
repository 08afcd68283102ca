// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdint>

#include "harness.hpp"

/// What libFuzzer calls; WARPAGG_HARNESS names one of harness.hpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
    gs_fuzz::WARPAGG_HARNESS({reinterpret_cast<const char*>(bytes), count});
    return 0;
}
