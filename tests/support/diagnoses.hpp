// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Kernels that break a rule, and their twins that keep it: the one is diagnosed in 200 of 200 schedules, the
/// other in none.

#include <cstdint>
#include <filesystem>
#include <string>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>

#include "for_each_seed.hpp"

namespace {

using warpagg::emulator::checked;
using warpagg::emulator::diagnosis;
using warpagg::emulator::grid;
using warpagg::emulator::report;
using warpagg::emulator::try_launch;
using warpagg::emulator::watched;

#if defined(WARPAGG_ASAN) || defined(WARPAGG_TSAN)  // where to fork takes some 20 ms
constexpr std::uint64_t schedules = 10;
#else
constexpr std::uint64_t schedules = 200;
#endif
constexpr std::uint32_t everyone = 0xffffffffu;

constexpr std::uint32_t lanes(unsigned first, unsigned last) {
    return (everyone >> (31 - last)) & (everyone << first);
}

/// What a broken kernel must be told. The kernel notes `__LINE__` where it breaks the rule.
struct expected {
    diagnosis what;
    std::uint64_t lanes;
    const char* function;
    const unsigned* line;
    const unsigned* other_line =
        nullptr;  ///< the second place, if there is one; the two come in either order
    unsigned warp = 0;
};

inline void check_report(const report& r, const expected& e) {
    INFO(r.text());
    CHECK(std::string(name(r.what)) == name(e.what));
    CHECK(r.lanes == e.lanes);
    CHECK(r.warp == e.warp);
    const unsigned other_line = e.other_line == nullptr ? 0 : *e.other_line;
    const bool swapped = other_line != *e.line && r.at.line == other_line;
    CHECK(r.at.line == (swapped ? other_line : *e.line));
    CHECK(r.other.line == (swapped ? *e.line : other_line));
    REQUIRE(r.at.file != nullptr);
    CHECK(std::string(swapped ? r.other.function : r.at.function) == e.function);
    CHECK(std::filesystem::path(r.at.file).filename().string().starts_with("test_"));
    CHECK(r.sentence.back() == '.');
}

template <class Warp = checked, class Kernel>
void is_diagnosed(const expected& e, grid g, const Kernel& kernel) {
    for_each_seed(schedules, [&](std::uint64_t seed) {
        g.seed = seed;
        const report r = try_launch<Warp>(g, kernel);
        CHECK(r.seed == seed);
        check_report(r, e);
    });
}
template <class Warp = checked, class Kernel>
void is_clean(grid g, const Kernel& kernel) {
    for_each_seed(schedules, [&](std::uint64_t seed) {
        g.seed = seed;
        CHECK(try_launch<Warp>(g, kernel).text() == "");
    });
}

}  // namespace
