// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Sums in order, on the `backend` that the including file has chosen.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>
#include <warpagg/segmented_sum.hpp>

namespace {

using namespace warpagg;

/// One warp takes all tiles.
template <class T>
struct sum_tiles {
    segmented_sum_tiles<T> tiles;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        for (unsigned i = 0; i < tiles.tiles(tiles.n); ++i) tiles(w, i);
    }
};
template <class T>
struct fix_up_edges {
    segmented_sum_fixup<T> fixup;

    template <class W>
    WARPAGG_HD void operator()(const W&) const {
        for (std::size_t edge = 0; edge < fixup.edges; ++edge) fixup(edge);
    }
};

/// The index among sorted keys; -1 if the key does not occur.
template <class T>
std::vector<T> ordered_sums(const std::vector<unsigned>& keys, const std::vector<T>& values, unsigned sums) {
    const auto n = static_cast<unsigned>(keys.size());
    const std::size_t edges = 2 * segmented_sum_tiles<T>::tiles(n);
    typename backend::template memory<unsigned> in(keys), edge_keys(std::vector<unsigned>(edges + 1));
    typename backend::template memory<T> of(values), to(std::vector<T>(sums, T(-1))),
        edge_sums(std::vector<T>(edges + 1));
    backend::launch(sum_tiles<T>{{in.data(), of.data(), n, to.data(), edge_keys.data(), edge_sums.data()}});
    backend::launch(fix_up_edges<T>{{edge_keys.data(), edge_sums.data(), edges, to.data()}});
    return to.download();
}

/// Keys of which each occurs as often as `often` says.
std::vector<unsigned> keys_of(const std::vector<unsigned>& often) {
    std::vector<unsigned> keys;
    for (unsigned k = 0; k < often.size(); ++k) keys.insert(keys.end(), often[k], k);
    return keys;
}

/// Whole numbers: their sums have no error.
template <class T>
void check_whole(const std::vector<unsigned>& often) {
    const std::vector<unsigned> keys = keys_of(often);
    std::vector<T> values, expected(often.size(), T(-1));
    for (std::size_t i = 0; i < keys.size(); ++i) {
        values.push_back(static_cast<T>(i % 19) - T(9));
        T& sum = expected[keys[i]];
        sum = (i == 0 || keys[i] != keys[i - 1] ? T(0) : sum) + values.back();
    }
    CHECK(ordered_sums(keys, values, static_cast<unsigned>(often.size())) == expected);
}

}  // namespace

static_assert(segmented_sum_tiles<float>::tiles(0) == 0 && segmented_sum_tiles<float>::tiles(1025) == 2 &&
              segmented_sum_tiles<float>::tiles(0xffffffffu) == 1u << 22);

TEST_SUITE_BEGIN(backend::name);

TEST_CASE("sums in order are complete, wherever keys begin and end") {
    check_whole<float>({1});
    check_whole<float>({0, 1, 0});
    check_whole<float>({5, 0, 3, 32, 1, 31});
    check_whole<float>({1024});
    check_whole<float>({1024, 1024, 1});
    check_whole<float>({1023, 2, 1023});
    check_whole<float>({5000});
    check_whole<float>({3, 5000, 4, 0, 1100, 1});
    check_whole<float>(std::vector<unsigned>(3000, 1));
    check_whole<double>({992, 32, 31, 1, 2047, 0, 40});
    check_whole<std::int32_t>({3, 5000, 4, 0, 1100, 1});
    std::mt19937 random(3);
    for (int i = 0; i < (backend::every_nth_mask > 1 ? 3 : 60); ++i) {
        std::vector<unsigned> often(40);
        for (unsigned& n : often) {
            const auto most = 1u << (random() % 11 + 1);
            n = random() % 4 == 0 ? 0 : static_cast<unsigned>(random()) % most;
        }
        check_whole<float>(often);
    }
}

TEST_CASE("sums in order err by no more than their bound, and keep the order") {
    const std::vector<unsigned> often{700, 3000, 1, 300}, keys = keys_of(often);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<float> values;
    for (std::size_t i = 0; i < keys.size(); ++i)
        values.push_back(std::exp(2 * normal(random)) * normal(random));
    const std::vector<float> found = ordered_sums(keys, values, 4);
    std::size_t first = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        double sum = 0, magnitude = 0;
        for (std::size_t i = first; i < first + often[k]; ++i) {
            sum += static_cast<double>(values[i]);
            magnitude += std::abs(static_cast<double>(values[i]));
        }
        first += often[k];
        constexpr unsigned width = backend::warp::size;
        const double steps = often[k] / 1024.0 + 1024.0 / width + std::bit_width(width) - 1 + 5;
        CHECK(std::abs(static_cast<double>(found[k]) - sum) <= steps * 0x1p-24 * magnitude);
    }
    // Another order is another sum: nothing sorts behind the caller's back.
    std::reverse(values.begin() + 700, values.begin() + 3700);
    CHECK(ordered_sums(keys, values, 4)[1] != found[1]);
}

TEST_SUITE_END();
