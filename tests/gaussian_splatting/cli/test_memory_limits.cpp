// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <optional>

#include "cli/memory_limits.hpp"

using gs::train::parameter_storage;
using enum gs::train::moment_precision;

namespace {

/// A million Gaussians of SH degree 3 that need 900 MB with float moments, 708 of them for parameters.
gs::cli::largest_model million(std::uint64_t device_limit, std::uint64_t host_bytes = 1000000000) {
    return {1000000, 3, {.gaussians = 800000000, .others = 100000000}, device_limit, host_bytes};
}

}  // namespace

TEST_CASE("storage of parameters: no more is given up than the device's memory demands") {
    const auto chosen = [](std::uint64_t limit) { return storage_for(million(limit), {}, false); };
    CHECK(chosen(0) == parameter_storage{full, 4});
    CHECK(chosen(900000000) == parameter_storage{full, 4});
    CHECK(chosen(899999999) == parameter_storage{compact, 4});
    CHECK(chosen(540000000) == parameter_storage{compact, 4});
    CHECK(chosen(539999999) == parameter_storage{compact, 3});
    CHECK(chosen(427999999) == parameter_storage{compact, 2});
    CHECK(chosen(347999999) == parameter_storage{compact, 1});
    CHECK(chosen(1) == parameter_storage{compact, 1});
}

TEST_CASE("storage of parameters: a precision that is given stays, and floats can be required") {
    CHECK(storage_for(million(500000000), full, false) == parameter_storage{full, 2});
    CHECK(storage_for(million(500000000), {}, true) == parameter_storage{full, 2});
    CHECK(storage_for(million(0), compact, true) == parameter_storage{compact, 4});
}

TEST_CASE("storage of parameters: the host gets no more than it has room for") {
    CHECK(storage_for(million(1, 0), {}, false) == parameter_storage{compact, 4});
    CHECK(storage_for(million(1, 111999999), {}, false) == parameter_storage{compact, 4});
    CHECK(storage_for(million(1, 112000000), {}, false) == parameter_storage{compact, 3});
    CHECK(storage_for(million(1, 239999999), {}, false) == parameter_storage{compact, 2});
}
