// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>

#include "core/error.hpp"
#include "device/cpu/cpu.hpp"

namespace {

using gs::device::cpu;

struct write_zero {
    float* to;
    void operator()(std::size_t i) const { to[i] = 0; }
};
struct write_one {
    float* to;
    void operator()(std::size_t i) const { to[i] = 1; }
};

/// A step with host values that decide about its launches and its memory.
struct step_of_features {
    cpu device;
    cpu::buffer<float> values, more;
    bool learns = false;
    std::size_t size = 100;

    step_of_features() { values.resize(1000); }

    void run(const gs::device::graph_key& key) {
        device.iteration(key, [&] {
            device.for_each_index(size, write_zero{values.data()});
            if (learns) device.for_each_index(10, write_one{values.data()});
        });
    }
};

constexpr const char* remedy = "add the host value that decides about it to the memory_key()";

}  // namespace

TEST_CASE("graph key: equal steps may have equal keys") {
    step_of_features step;
    for (int i = 0; i < 3; ++i) CHECK_NOTHROW(step.run({1}));
}

TEST_CASE("graph key: a host value that switches a kernel on is found if the key lacks it") {
    step_of_features step;
    step.run({1});
    step.learns = true;
    CHECK_THROWS_WITH_AS(step.run({1}), doctest::Contains(remedy), gs::error);
    CHECK_NOTHROW(step.run({1, 1}));  // with the value in the key
    step.learns = false;
    CHECK_NOTHROW(step.run({1}));
    step.learns = true;
    step.run({2});
    step.learns = false;
    CHECK_THROWS_WITH_AS(step.run({2}), doctest::Contains(remedy), gs::error);
}

TEST_CASE("graph key: a host value that changes a kernel's range is found if the key lacks it") {
    step_of_features step;
    step.run({1});
    step.size = 101;
    CHECK_THROWS_WITH_AS(step.run({1}), doctest::Contains(remedy), gs::error);
    CHECK_NOTHROW(step.run({101}));
}

TEST_CASE("graph key: only the first step with a key may allocate") {
    step_of_features step;
    const auto allocate = [&](std::size_t n) { step.device.iteration({7}, [&] { step.more.resize(n); }); };
    CHECK_NOTHROW(allocate(10));
    CHECK_NOTHROW(allocate(5));
    CHECK_THROWS_WITH_AS(allocate(20), doctest::Contains("allocated memory"), gs::error);
}

TEST_CASE("graph key: a step that fails leaves nothing behind") {
    step_of_features step;
    CHECK_THROWS_AS(step.device.iteration({1}, [] { throw gs::error("stop"); }), gs::error);
    CHECK_NOTHROW(step.run({1}));
    CHECK_NOTHROW(step.run({1}));
}
