// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "ranks/run.hpp"
#include "training/view_strips.hpp"

using gs::row_range;
using gs::train::balanced_rows;

namespace {
constexpr std::array<std::size_t, 1> view_0{0};
}

TEST_CASE("strips: each row belongs to one part, whatever the weights are") {
    for (const auto& weights : std::vector<std::vector<std::uint64_t>>{
             {}, {5}, {0, 0, 0}, {1, 2, 3, 4, 5, 6, 7}, {100, 0, 0, 0}, {0, 0, 100}, {9, 1, 1, 1, 1, 9}})
        for (int parts = 1; parts < 6; ++parts) {
            CAPTURE(parts);
            int next = 0;
            for (int part = 0; part < parts; ++part) {
                const row_range rows = balanced_rows(weights, part, parts);
                CHECK(rows.first == next);
                CHECK(rows.last >= rows.first);
                next = rows.last;
            }
            CHECK(next == static_cast<int>(weights.size()));
        }
}

TEST_CASE("strips: parts have about the same sum of weights") {
    const std::vector<std::uint64_t> equal(12, 50);
    for (int part = 0; part < 4; ++part)
        CHECK(balanced_rows(equal, part, 4) == row_range{3 * part, 3 * part + 3});
    const std::vector<std::uint64_t> below{1, 1, 1, 1, 1, 1, 3, 3};
    CHECK(balanced_rows(below, 0, 2) == row_range{0, 6});
    CHECK(balanced_rows(below, 1, 2) == row_range{6, 8});
}

TEST_CASE("strips: the loss decides how many tile rows beyond its own a rank renders") {
    const gs::raster::view_strip middle{{2, 4}, 10}, wide{{2, 4}, 17}, all{{2, 4}, 1 << 30}, none{{3, 3}, 10};
    CHECK(middle.listed(6) == row_range{1, 5});
    CHECK(middle.listed(4) == row_range{1, 4});
    CHECK(wide.listed(9) == row_range{0, 6});
    CHECK(all.listed(9) == row_range{0, 9});
    CHECK(none.listed(6).count() == 0);
    CHECK(middle.own_pixels(100) == row_range{32, 64});
    CHECK(middle.own_pixels(50) == row_range{32, 50});
}

TEST_CASE("strips: known work of tile rows moves the borders between ranks") {
    gs::camera camera;
    camera.width = 16;
    camera.height = 64;
    const auto end = gs::ranks::run(2, [&](gs::ranks::communicator& all) {
        gs::train::view_strips strips;
        strips.reset(1);
        const row_range before = strips.of(view_0, camera, 10, all)->own;
        const auto first = strips.of(view_0, camera, 10, all);
        const auto listed = first->listed_by_all(4);
        if (first->own_of_all != std::vector<row_range>{{0, 2}, {2, 4}} || listed.ranks != 2 ||
            listed.of[0] != row_range{0, 3} || listed.of[1] != row_range{1, 4})
            return 2;
        strips.note(0, {900, 0, 0, 0});
        const row_range after = strips.of(view_0, camera, 10, all)->own;
        strips.note(0, {900, 0});  // of another size
        const row_range unknown = strips.of(view_0, camera, 10, all)->own;
        const bool is_first = all.is_first();
        return before == (is_first ? row_range{0, 2} : row_range{2, 4}) &&
                       after == (is_first ? row_range{0, 1} : row_range{1, 4}) && unknown == before
                   ? 0
                   : 1;
    });
    CHECK(end.code == 0);
    CHECK(end.reason == "");
    gs::ranks::communicator alone;
    gs::train::view_strips strips;
    strips.reset(1);
    CHECK_FALSE(strips.of(view_0, camera, 10, alone).has_value());
}

TEST_CASE("strips: a step expects the splats that its view had sent, for the present shares") {
    gs::camera camera;
    camera.width = 16;
    camera.height = 64;
    const auto end = gs::ranks::run(2, [&](gs::ranks::communicator& all) {
        gs::train::view_strips strips;
        strips.reset(2);
        // Two ranks have half of this many Gaussians each.
        const auto half = [](std::size_t gaussians) { return gs::ranks::shares(gaussians, 1, 2); };
        const auto expected = [&](std::size_t view, std::size_t gaussians) {
            return strips.of_step(std::array{view}, camera, 10, all, half(gaussians))->windows;
        };
        if (expected(0, 1000)) return 1;
        strips.note_sent(0, {0, 320, 160, 0}, half(1000));
        if (expected(1, 1000)) return 2;
        // A sixteenth more, and at least 64 places.
        const auto same = expected(0, 1000), grown = expected(0, 2000);
        if (same->sent_by(0).of(1).count() != 340 + 64 || same->sent_by(1).of(0).count() != 170 + 64)
            return 3;
        if (grown->sent_by(0).of(1).count() != 680 + 64) return 4;
        if (same->sent_by(0).of(0).count() != 0 || same->sent_by(1).of(1).count() != 0) return 5;
        const gs::ranks::shares moved(std::vector<std::size_t>{250, 750});
        const auto of_moved = strips.of_step(view_0, camera, 10, all, moved)->windows;
        if (of_moved->sent_by(0).of(1).count() != 170 + 64 || of_moved->sent_by(1).of(0).count() != 255 + 64)
            return 10;
        // Strips for scores list other rows.
        if (strips.of(view_0, camera, 0, all)->windows) return 6;
        strips.note(0, {900, 0, 0, 0});  // the borders move for the first time
        if (expected(0, 1000)) return 7;
        strips.note_sent(0, {0, 10, 10, 0}, half(1000));
        strips.note(0, {800, 0, 0, 0});
        if (!expected(0, 1000)) return 8;
        strips.reset(2);
        return expected(0, 1000) ? 9 : 0;
    });
    CHECK(end.reason == "");
    CHECK(end.code == 0);
}
