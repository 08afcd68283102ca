// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

#include "render/tiles/tile_reach.hpp"

using gs::raster::reaches_any_tile;
using gs::raster::splat;
using gs::raster::tile_size;

namespace {

/// Of any size, thinness and direction, in an image of 40 x 30 tiles and around it.
splat<float> random_splat(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    splat<float> s{};
    s.x = tile_size * (80 * unit(random) - 20);
    s.y = tile_size * (60 * unit(random) - 15);
    s.p = std::exp2(-10 * unit(random));
    s.q = std::exp2(-10 * unit(random));
    s.r = (unit(random) < 0.2f ? 0 : 4 * unit(random) - 2) * s.p;
    s.dx_per_dy = -s.r * s.q / (s.p * s.p + s.r * s.r);
    s.dy_per_dx = -s.r / s.q;
    s.cutoff = 8 * unit(random);
    return s;
}

/// The least exponent over the pixels of any tile in the box, by looking at each.
double least_of_all(const splat<float>& f, unsigned x0, unsigned x1, unsigned y0, unsigned y1) {
    double least = 1e30;
    const auto offset = [](unsigned tile, float at) {
        return tile_size * double{1} * tile + 0.5 - static_cast<double>(at);
    };
    for (unsigned row = y0; row < y1; ++row)
        for (unsigned column = x0; column < x1; ++column) {
            const double x = offset(column, f.x), y = offset(row, f.y), side = tile_size - 1;
            least = std::min(least, gs::raster::least_exponent<double>(
                                        f.p, f.q, f.r, f.dx_per_dy, f.dy_per_dx, x, x + side, y, y + side));
        }
    return least;
}

}  // namespace

TEST_CASE("a splat reaches some tile of its box where looking at each finds one") {
    std::mt19937 random(5);
    int reaching = 0, missing = 0, undecided = 0;
    for (int i = 0; i < 20000; ++i) {
        const splat<float> s = random_splat(random);
        const auto below = [&](unsigned end) { return static_cast<unsigned>(random() % end); };
        const unsigned x0 = below(40), x1 = x0 + below(41 - x0), y0 = below(30), y1 = y0 + below(31 - y0);
        const double least = least_of_all(s, x0, x1, y0, y1), cutoff = static_cast<double>(s.cutoff);
        const warpagg::emulator::serial one{};
        const bool found = reaches_any_tile(one, s, x0, x1, y0, y1, true);
        CHECK_FALSE(reaches_any_tile(one, s, x0, x1, y0, y1, false));
        if (std::abs(least - cutoff) <= 1e-5 * cutoff) {
            ++undecided;
            continue;
        }
        CAPTURE(i);
        CHECK(found == (least < cutoff));
        ++(found ? reaching : missing);
    }
    CHECK(reaching > 2000);
    CHECK(missing > 2000);
    CHECK(undecided < 20);
}

TEST_CASE("lanes look for tiles each for itself") {
    using lanes_of_8 = warpagg::emulator::narrow_lanes<8>;
    using real = warpagg::simd_value<float, 8>;
    using number = warpagg::simd_value<std::uint32_t, 8>;
    std::mt19937 random(6);
    const warpagg::emulator::serial one{};
    const lanes_of_8 w;
    int reaching = 0;
    for (int i = 0; i < 2000; ++i) {
        real values[8];
        number x0(0u), x1(0u), y0(0u), y1(0u);
        warpagg::simd_value<bool, 8> asked(false);
        for (auto& v : values) v = real(0.0f);
        bool expected[8];
        for (int lane = 0; lane < 8; ++lane) {
            const splat<float> s = random_splat(random);
            const float of_splat[8] = {s.x, s.y, s.p, s.q, s.r, s.dx_per_dy, s.dy_per_dx, s.cutoff};
            for (int k = 0; k < 8; ++k) values[k].set(lane, of_splat[k]);
            const auto below = [&](unsigned end) { return static_cast<unsigned>(random() % end); };
            x0.set(lane, below(40));
            x1.set(lane, x0[lane] + below(41 - x0[lane]));
            y0.set(lane, below(30));
            y1.set(lane, y0[lane] + below(31 - y0[lane]));
            asked.set(lane, below(4) != 0);
            expected[lane] = reaches_any_tile(one, s, x0[lane], x1[lane], y0[lane], y1[lane], asked[lane]);
            reaching += expected[lane] ? 1 : 0;
        }
        splat<real> s{};
        s.x = values[0], s.y = values[1], s.p = values[2], s.q = values[3], s.r = values[4];
        s.dx_per_dy = values[5], s.dy_per_dx = values[6], s.cutoff = values[7];
        const auto found = reaches_any_tile(w, s, x0, x1, y0, y1, asked);
        CAPTURE(i);
        for (int lane = 0; lane < 8; ++lane) CHECK(found[lane] == expected[lane]);
    }
    CHECK(reaching > 1000);
}

TEST_CASE("a splat between two rows of tiles reaches none, though it reaches their box") {
    splat<float> s{};
    s.x = 40;
    s.y = 16;  // pixel centers are at 15.5 and 16.5
    s.p = 0.01f;
    s.q = 10;
    s.cutoff = 8;
    const warpagg::emulator::serial one{};
    CHECK_FALSE(reaches_any_tile(one, s, 0u, 5u, 0u, 2u, true));
    s.q = 5;
    CHECK(reaches_any_tile(one, s, 0u, 5u, 0u, 2u, true));
    CHECK(reaches_any_tile(one, s, 2u, 3u, 0u, 1u, true));
}
