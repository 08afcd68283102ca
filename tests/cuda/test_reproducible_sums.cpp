// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Sums of the GPU have the same bits as those of the CPU emulator, in any order and shape of launch.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "../support/backends/checked.hpp"
// The order matters: the sums take memory of the backend.
#include "reproducible_sums.hpp"

namespace {

constexpr unsigned records = 20, rows_per_input = 700, runs = 100;

/// The only warp of a launch.
template <class Kernel>
struct only_warp {
    Kernel kernel;
    template <class W>
    void operator()(const W& w) const {
        kernel(w, std::size_t{0}, std::size_t{1});
    }
};
struct run_on_cpu {
    template <class Kernel>
    void operator()(const Kernel& kernel) const {
        backend::launch(only_warp<Kernel>{kernel});
    }
};

/// Half of the rows have key 3. The values have exponents of 40 binades, so plain sums depend on their
/// order.
template <class T>
rows_to_add<T> draw_rows(unsigned width, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    std::uniform_int_distribution<int> exponent(-40, 0);
    rows_to_add<T> rows{width, {}, {}, {}};
    for (unsigned i = 0; i < rows_per_input; ++i)
        rows.keys.push_back(random() % 2 == 0 ? 3 : static_cast<std::int64_t>(random() % records));
    const auto draw = [&] { return static_cast<T>(std::ldexp(unit(random), exponent(random))); };
    for (unsigned i = 0; i < rows_per_input * width; ++i) rows.values.push_back(draw());
    for (unsigned i = 0; i < records * width; ++i) rows.table.push_back(draw());
    return rows;
}

/// Moves the rows to other places. The first run has them in the order of their keys.
template <class T>
void change_order(rows_to_add<T>& rows, unsigned run, std::mt19937& random) {
    std::vector<unsigned> order(rows.keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, random);
    if (run == 0) std::ranges::stable_sort(order, {}, [&](unsigned i) { return rows.keys[i]; });
    const rows_to_add<T> before = rows;
    for (std::size_t i = 0; i < order.size(); ++i) {
        rows.keys[i] = before.keys[order[i]];
        for (unsigned k = 0; k < rows.width; ++k)
            rows.values[i * rows.width + k] = before.values[std::size_t{order[i]} * rows.width + k];
    }
}

launch_shape draw_shape(std::mt19937& random) {
    const auto up_to = [&](unsigned most) { return static_cast<unsigned>(random() % most) + 1; };
    return {up_to(40), up_to(8)};
}

/// Returns how many of two tables' values differ in a bit.
template <class T>
long differing(const std::vector<T>& a, const std::vector<T>& b) {
    using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    REQUIRE(a.size() == b.size());
    return std::transform_reduce(a.begin(), a.end(), b.begin(), 0L, std::plus{}, [](T x, T y) {
        return std::bit_cast<bits>(x) != std::bit_cast<bits>(y) ? 1L : 0L;
    });
}

}  // namespace

TEST_SUITE_BEGIN("reproducible sums");

TEST_CASE_TEMPLATE("fixed-point scatter: the GPU has the CPU's bits in 100 runs", T, float, double) {
    for (const unsigned width : {4u, 64u}) {
        CAPTURE(width);
        std::mt19937 random(width);
        rows_to_add<T> rows = draw_rows<T>(width, random);
        const std::vector<T> expected = fixed_point_sums(rows, run_on_cpu{});
        for (unsigned run = 0; run < runs; ++run) {
            CAPTURE(run);
            change_order(rows, run, random);
            CHECK(differing(fixed_point_sums_on_gpu(rows, draw_shape(random)), expected) == 0);
        }
    }
}

TEST_CASE("exact sums: the GPU has the CPU's bits in 100 runs") {
    std::mt19937 random(1);
    rows_to_add<float> rows = draw_rows<float>(4, random);
    for (float& v : rows.values) {  // all exponents whose sums are finite
        const auto any = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        v = std::isfinite(any) ? any * 0x1p-20f : 0.0f;
    }
    const std::vector<float> expected = exact_sums(rows, run_on_cpu{});
    for (unsigned run = 0; run < runs; ++run) {
        CAPTURE(run);
        change_order(rows, run, random);
        CHECK(differing(exact_sums_on_gpu(rows, draw_shape(random)), expected) == 0);
    }
}

TEST_SUITE_END();
