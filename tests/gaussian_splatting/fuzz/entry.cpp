// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdint>

#include "harness.hpp"

/// What libFuzzer calls. WARPAGG_HARNESS is the name of a harness.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
    static const gs_fuzz::harness& harness = gs_fuzz::harness_of(WARPAGG_HARNESS);
    harness.run({reinterpret_cast<const char*>(bytes), count});
    return 0;
}
