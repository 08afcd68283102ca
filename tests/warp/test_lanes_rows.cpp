// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Rows: 32 neighboring values, one a lane, loaded and stored by the SIMD lanes.

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>
#include <warpagg/warp/simd.hpp>

namespace {

constexpr int width = 32;
const warpagg::emulator::lanes warp{};

warpagg::simd_value<bool, width> flags(std::uint32_t mask) {
    warpagg::simd_value<bool, width> f(false);
    for (int lane = 0; lane < width; ++lane) f.set(lane, ((mask >> lane) & 1u) != 0);
    return f;
}

/// Calls f(memory, first, mask) for rows that lie within the memory or stick out of it with inactive lanes.
template <class T, class F>
void for_rows(F f) {
    std::mt19937 random(29);
    const std::uint32_t masks[] = {0u, 0xffffffffu, 1u, 0x80000000u, 0x00ff00ffu, 0xfffe0000u};
    for (const std::ptrdiff_t first : {0, 1, 5, 8, 40, -1, -9, 60})
        for (int round = 0; round < 12; ++round) {
            std::vector<T> memory(72);  // on the heap, for the address sanitizer
            for (T& x : memory) x = static_cast<T>(random() % 1000 + 1);
            std::uint32_t mask = round < 6 ? masks[round] : static_cast<std::uint32_t>(random());
            for (std::ptrdiff_t lane = 0; lane < width; ++lane)
                if (first + lane < 0 || first + lane >= 72) mask &= ~(1u << lane);
            INFO("first ", first, ", mask ", mask);
            f(memory, first, mask);
        }
}

}  // namespace

TEST_SUITE_BEGIN("rows");

TEST_CASE_TEMPLATE("a row is loaded where lanes are active", T, float, double, std::int32_t, std::uint32_t) {
    for_rows<T>([](const std::vector<T>& memory, std::ptrdiff_t first, std::uint32_t mask) {
        const auto row = warp.load_row(memory.data(), first, flags(mask));
        for (int lane = 0; lane < width; ++lane) {
            const bool active = ((mask >> lane) & 1u) != 0;
            CHECK(row[lane] == (active ? memory[static_cast<std::size_t>(first + lane)] : T{}));
        }
        if (mask != 0xffffffffu) return;
        const auto whole = warp.load_row(memory.data(), first);
        for (int lane = 0; lane < width; ++lane) CHECK(whole[lane] == row[lane]);
    });
}

TEST_CASE_TEMPLATE("a row is stored where lanes are active", T, float, double, std::int32_t, std::uint32_t) {
    for_rows<T>([](std::vector<T> memory, std::ptrdiff_t first, std::uint32_t mask) {
        std::vector<T> expected = memory;
        warpagg::simd_value<T, width> values;
        for (int lane = 0; lane < width; ++lane) {
            values.set(lane, static_cast<T>(2000 + lane));
            if (((mask >> lane) & 1u) != 0) expected[static_cast<std::size_t>(first + lane)] = values[lane];
        }
        warp.store_row(memory.data(), first, values, flags(mask));
        CHECK(memory == expected);
    });
}

TEST_SUITE_END();
