// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What the emulator diagnoses of undefined values in a program that does not include
/// fork_shadow_process.hpp.

#include "../support/diagnoses.hpp"

namespace {

/// Reads from lane 20, which takes no part, in lane 5.
float read_undefined(const checked& w) {
    return w.shfl_sync(lanes(0, 15), 1.0f, w.lane() == 5 ? 20 : w.lane());
}

}  // namespace

TEST_SUITE_BEGIN("checked");

TEST_CASE("without a shadow process, undefined values that are written are diagnosed") {
    float floats[32] = {};
    const report r = try_launch({}, [&](const checked& w) {
        if (w.lane() >= 16) return;
        w.store(floats, w.lane(), 2 * read_undefined(w), true);
    });
    CHECK(r.what == diagnosis::inactive_lane_read);
}

TEST_CASE("without a shadow process, undefined values that are compared go unnoticed") {
    int ints[32] = {};
    const report r = try_launch({}, [&](const checked& w) {
        if (w.lane() >= 16) return;
        w.store(ints, w.lane(), read_undefined(w) > 0 ? 1 : 2, true);
    });
    CHECK(r.ok());
    CHECK(ints[0] == 1);
}

TEST_SUITE_END();
