// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>

#include "cli/memory_limits.hpp"

using gs::cli::precision_for;
using gs::cli::storage_for;
using gs::train::parameter_storage;
using enum gs::train::moment_precision;

namespace {

/// A million Gaussians of SH degree 3 that need 900 MB with float moments, 708 of them for parameters.
gs::cli::model_memory million(std::uint64_t device_limit, std::uint64_t host_limit = 1000000000) {
    return {1000000, 3, {.gaussians = 800000000, .others = 100000000}, device_limit, host_limit};
}

}  // namespace

TEST_CASE("storage of parameters: moments are compact if floats exceed the limit, or if that is wanted") {
    const auto& forecast = million(0).forecast;
    CHECK(precision_for({}, forecast, 0) == full);
    CHECK(precision_for({}, forecast, 900000000) == full);
    CHECK(precision_for({}, forecast, 899999999) == compact);
    CHECK(precision_for(full, forecast, 1) == full);
    CHECK(precision_for(compact, forecast, 0) == compact);
}

TEST_CASE("storage of parameters: no more SH degrees lie in host memory than the device's limit demands") {
    const auto chosen = [](std::uint64_t limit) { return storage_for(million(limit), compact); };
    CHECK(chosen(0) == parameter_storage{compact, 4});
    CHECK(chosen(540000000) == parameter_storage{compact, 4});
    CHECK(chosen(539999999) == parameter_storage{compact, 3});
    CHECK(chosen(427999999) == parameter_storage{compact, 2});
    CHECK(chosen(347999999) == parameter_storage{compact, 1});
    CHECK(chosen(1) == parameter_storage{compact, 1});
    CHECK(storage_for(million(899999999), full) == parameter_storage{full, 3});
}

TEST_CASE("storage of parameters: the host gets no more than it has room for") {
    CHECK(storage_for(million(1, 0), compact) == parameter_storage{compact, 4});
    CHECK(storage_for(million(1, 111999999), compact) == parameter_storage{compact, 4});
    CHECK(storage_for(million(1, 112000000), compact) == parameter_storage{compact, 3});
    CHECK(storage_for(million(1, 239999999), compact) == parameter_storage{compact, 2});
}
