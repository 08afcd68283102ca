// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What warp_match_reduce_atomic asks of its callers, and types of several numbers.

#include <doctest/doctest.h>

#include <cstdint>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/serial.hpp>

namespace {

namespace emulator = warpagg::emulator;

struct particle {
    float mass, momentum[2];
};

}  // namespace

template <>
struct warpagg::aggregate_traits<particle> : warpagg::aggregate_of<float, 3> {};

TEST_SUITE_BEGIN("match rules");

TEST_CASE("the base is the same in every lane") {
    float memory[80] = {};
    const auto add = [&](unsigned step) {
        return emulator::try_launch({}, [&](const emulator::checked& w) {
            const float one[1] = {1.0f};
            warpagg::warp_match_reduce_atomic(w, memory + step * (w.lane() % 2), w.lane(), one, true);
        });
    };
    const emulator::report wrong = add(1);
    CHECK(wrong.what == emulator::diagnosis::destination_not_uniform);
    CHECK(wrong.lanes == 0xaaaaaaaau);
    CHECK(add(0).ok());
}

TEST_CASE("assume_busy is verified") {
    float memory[1] = {};
    const auto add = [&](unsigned active) {
        return emulator::try_launch({}, [&](const emulator::checked& w) {
            const float one[1] = {1.0f};
            warpagg::warp_match_reduce_atomic(w, memory, 0, one, w.lane() < active,
                                              warpagg::policy{warpagg::assume_busy});
        });
    };
    CHECK(add(0).what == emulator::diagnosis::idle_warp);
    CHECK(add(1).ok());
}

TEST_CASE("a type of several numbers goes to the record of its key") {
    particle cells[3] = {};
    emulator::launch({}, [&](const emulator::checked& w) {
        const auto x = static_cast<float>(w.lane());
        warpagg::warp_match_reduce_atomic(w, cells, w.lane() % 3, particle{1.0f, {x, -x}}, w.lane() < 30);
    });
    for (unsigned k = 0; k < 3; ++k) {
        CHECK(cells[k].mass == 10.0f);
        CHECK(cells[k].momentum[0] == 135.0f + 10.0f * static_cast<float>(k));
        CHECK(cells[k].momentum[1] == -cells[k].momentum[0]);
    }
}

TEST_SUITE_END();
