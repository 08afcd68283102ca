// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "engines.hpp"
#include "optimize/trained_parameters.hpp"
#include "training/initialize.hpp"

using enum gs::train::moment_precision;

namespace {

using parameters = gs::train::trained_parameters<gs::device::cpu>;
constexpr std::size_t count = 40 * gs::block_length;
constexpr auto sh3 = gs::parameter::sh3;

/// 40 blocks of degree 3, with values and moments from this degree on in host memory.
parameters on_host(gs::device::cpu& device, gs::train::moment_precision precision, int first_degree) {
    gs::gaussians model = gs::from_points(std::vector<gs::colored_point>(count), 3, count, 1);
    for (std::size_t i = 0; i < model.sh_rest.size(); ++i) model.sh_rest[i] = static_cast<float>(i);
    parameters rows;
    rows.set_values(device, model);
    rows.set_storage(device, {precision, first_degree});
    rows.require_memory(device, count, 3);
    return rows;
}

void need(parameters& rows, const std::set<std::size_t>& blocks) {
    for (std::size_t b = 0; b < rows.cache.blocks(); ++b) rows.cache.needed()[b] = blocks.contains(b) ? 1 : 0;
}

bool is_cached(const parameters& rows, std::size_t block) {
    return rows.values.read().cache_slot[block] != 0;
}

/// Returns where a kernel finds the first coefficient of degree 3 of a block.
float& first_of(parameters& rows, std::size_t block) {
    const auto values = rows.values.write();
    const std::uint32_t slot = values.cache_slot[block];
    const std::size_t stride = gs::block_length * gs::width_of(sh3);
    return slot == 0 ? values[sh3][block * stride] : values.sh[7][(slot - 1) * stride];
}

}  // namespace

TEST_CASE("block cache: blocks keep their values and moments through any order of fetches") {
    gs::device::cpu device;
    for (const auto precision : {full, compact})
        for (const int first_degree : {1, 3}) {
            parameters rows = on_host(device, precision, first_degree);
            std::vector<float> expected(40);
            for (std::size_t b = 0; b < 40; ++b) expected[b] = first_of(rows, b);
            std::mt19937 random(7);
            std::size_t cached = 0;
            for (int step = 0; step < 200; ++step) {
                std::set<std::size_t> blocks;
                for (std::size_t k = 0; k < 1 + random() % 8; ++k) blocks.insert(random() % 40);
                need(rows, blocks);
                rows.cache.fetch(device);
                for (const std::size_t b : blocks) {
                    if (is_cached(rows, b)) ++cached;
                    REQUIRE(first_of(rows, b) == expected[b]);
                    first_of(rows, b) = expected[b] = static_cast<float>(random() % 1000);
                }
            }
            CHECK(cached > 500);
            const gs::gaussians model = rows.get_values(device, count, 3);
            const auto width = static_cast<std::size_t>(model.rest_width());
            for (std::size_t b = 0; b < 40; ++b)
                CHECK(model.sh_rest[b * gs::block_length * width + 24] == expected[b]);
            CHECK(rows.values.read().cache_slot == nullptr);
        }
}

TEST_CASE("block cache: needed blocks get all slots, and the others stay in host memory") {
    gs::device::cpu device;
    parameters rows = on_host(device, full, 2);
    const auto cached = [&] {
        std::size_t n = 0;
        for (std::size_t b = 0; b < 40; ++b) n += is_cached(rows, b) ? 1 : 0;
        return n;
    };
    constexpr std::size_t slots = 40 / gs::train::blocks_per_slot;
    need(rows, {1, 2});
    rows.cache.fetch(device);
    CHECK(cached() == 2);
    need(rows, {8, 9});
    rows.cache.fetch(device);
    CHECK(cached() == 4);  // empty slots come first
    need(rows, {1, 10, 11, 12, 13, 14, 15, 16});
    rows.cache.fetch(device);
    CHECK(cached() == slots);
    CHECK(is_cached(rows, 1));
    CHECK_FALSE(is_cached(rows, 8));
}

TEST_CASE("block cache: moments move with their block") {
    gs::device::cpu device;
    parameters rows = on_host(device, compact, 3);
    const std::size_t stride = gs::block_length * 7;
    for (std::size_t b = 0; b < 40; ++b) rows.packed.write()[sh3][b * stride] = static_cast<std::uint32_t>(b);
    need(rows, {20});
    rows.cache.fetch(device);
    const auto packed = rows.packed.write();
    const std::uint32_t slot = rows.values.read().cache_slot[20];
    REQUIRE(slot != 0);
    CHECK(packed.sh[7][(slot - 1) * stride] == 20);
    packed.sh[7][(slot - 1) * stride] = 99;
    rows.flush_cache(device);
    CHECK(rows.packed.write()[sh3][20 * stride] == 99);
    CHECK(rows.packed.write()[sh3][21 * stride] == 21);
}

TEST_CASE("block cache: without arrays in host memory the cache has no blocks") {
    gs::device::cpu device;
    parameters rows = on_host(device, full, 4);
    CHECK(rows.cache.blocks() == 0);
    CHECK(rows.values.read().cache_slot == nullptr);
}
