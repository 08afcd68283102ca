// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Scatter of rows, on the `backend` that the including file has chosen.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <random>
#include <vector>
#include <warpagg/scatter_in_blocks.hpp>

namespace {

using namespace warpagg;

/// One warp takes all tiles.
template <class Kernel>
struct every_tile {
    Kernel kernel;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        for (unsigned i = 0; i < kernel.tiles(W::size); ++i) kernel(w, i);
    }
};
template <class Kernel>
struct only_warp {
    Kernel kernel;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        kernel(w, std::size_t{0}, std::size_t{1});
    }
};

/// One block takes the part of each block.
template <class Scatter>
struct every_block {
    Scatter scatter;
    typename Scatter::sum* memory;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        const auto barrier = [&] { backend::barrier(w); };
        for (unsigned block = 0; block < scatter.blocks; ++block) {
            scatter(w, block, warp, memory, barrier);
            barrier();
        }
    }
};

/// Passes the kernel for the rows' width, as the kernels for narrow rows accept it.
template <class Rows, class F>
void with_kernel(const Rows& rows, const F& f) {
    constexpr unsigned lanes = backend::warp::size;
    if (rows.width % 4 == 0 && rows.width <= 16 && rows.width / 4 <= lanes)
        f(scatter_narrow_rows<4, Rows>{rows});
    else if (rows.width < 16 && rows.width <= lanes)
        f(scatter_narrow_rows<1, Rows>{rows});
    else if (rows.width <= 32)
        f(scatter_wide_rows<1, Rows>{rows});
    else
        f(scatter_wide_rows<2, Rows>{rows});
}
struct each_tile_alone {
    template <class Rows>
    void operator()(const Rows& rows) const {
        with_kernel(rows, [](const auto& kernel) {
            backend::launch(every_tile<std::remove_cvref_t<decltype(kernel)>>{kernel});
        });
    }
};
struct in_blocks {
    unsigned slots, blocks, warps;

    template <class Rows>
    void operator()(const Rows& rows) const {
        with_kernel(rows, [this](const auto& kernel) {
            using scatter = scatter_in_blocks<std::remove_cvref_t<decltype(kernel)>>;
            const unsigned size = scatter::template memory_size<backend::warp>(slots);
            typename backend::template memory<typename scatter::sum> memory(
                std::vector<typename scatter::sum>(size, -1));  // with no defined content
            backend::launch_block(warps, every_block<scatter>{{kernel, slots, blocks, warps}, memory.data()});
        });
    }
};

constexpr unsigned widths[] = {1, 2, 3, 4, 5, 8, 12, 15, 16, 20, 33, 64, 100};
constexpr unsigned records = 40;

enum class key_order { random, sorted, runs, equal, rising, frequent };
constexpr key_order key_orders[] = {key_order::random, key_order::sorted, key_order::runs,
                                    key_order::equal,  key_order::rising, key_order::frequent};

std::vector<std::int64_t> draw_keys(key_order order, unsigned n, std::mt19937_64& random) {
    std::vector<std::int64_t> keys(n);
    for (unsigned i = 0; i < n; ++i) switch (order) {
            case key_order::random:
            case key_order::sorted:
                keys[i] = static_cast<std::int64_t>(random() % records);
                break;
            case key_order::equal:
                keys[i] = 7;
                break;
            case key_order::rising:
                keys[i] = i % records;
                break;
            case key_order::runs:
            case key_order::frequent:
                keys[i] = static_cast<std::int64_t>(random() % 2 == 0 ? 3 : random() % records);
                break;
        }
    if (order == key_order::sorted || order == key_order::runs) std::ranges::sort(keys);
    return keys;
}

template <class T>
std::vector<T> draw_whole_numbers(std::size_t size, std::mt19937_64& random) {
    std::vector<T> values(size);
    for (T& v : values) v = static_cast<T>(static_cast<int>(random() % 201) - 100);
    return values;
}

/// The table after a scatter of whole numbers; it starts with `start`.
template <class Op, class T, class Key, class Add = each_tile_alone>
std::vector<T> combined_by_kernel(unsigned width, const std::vector<Key>& keys, const std::vector<T>& values,
                                  T start, const Add& add = {}) {
    typename backend::template memory<Key> key_memory(keys);
    typename backend::template memory<T> value_memory(values), table(std::vector<T>(records * width, start));
    add(scatter_rows<T, T, row_keys<Key>, unchanged, Op>{
        value_memory.data(), keys.size(), width, {key_memory.data(), records}, table.data()});
    return table.download();
}

template <class Op, class T, class Key>
std::vector<T> combined_in_order(unsigned width, const std::vector<Key>& keys, const std::vector<T>& values,
                                 T start) {
    std::vector<T> table(records * width, start);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto key = static_cast<std::size_t>(keys[i / width]);
        if (key < records) {
            T& to = table[key * width + i % width];
            to = Op::combine(to, values[i]);
        }
    }
    return table;
}

}  // namespace

TEST_CASE_TEMPLATE("rows of each width are added to the records of their keys", T, float, double,
                   std::int32_t, std::int64_t) {
    std::mt19937_64 random(1);
    for (const unsigned width : widths)
        for (const key_order order : key_orders)
            for (const unsigned n : {1u, 31u, 75u}) {
                CAPTURE(width);
                CAPTURE(static_cast<int>(order));
                CAPTURE(n);
                const auto keys = draw_keys(order, n, random);
                const auto values = draw_whole_numbers<T>(std::size_t{n} * width, random);
                CHECK(combined_by_kernel<operation::sum>(width, keys, values, T{5}) ==
                      combined_in_order<operation::sum>(width, keys, values, T{5}));
            }
}

TEST_CASE_TEMPLATE("the largest value of each key is found", T, std::int32_t, std::int64_t) {
    std::mt19937_64 random(2);
    for (const unsigned width : widths) {
        CAPTURE(width);
        const auto keys = draw_keys(key_order::random, 75, random);
        const auto values = draw_whole_numbers<T>(std::size_t{75} * width, random);
        CHECK(combined_by_kernel<operation::maximum>(width, keys, values, T{-20}) ==
              combined_in_order<operation::maximum>(width, keys, values, T{-20}));
    }
}

TEST_CASE_TEMPLATE("rows whose keys are outside the table are left out", T, float, std::int64_t) {
    std::mt19937_64 random(3);
    for (const unsigned width : {1u, 4u, 5u, 64u}) {
        CAPTURE(width);
        auto keys = draw_keys(key_order::frequent, 75, random);
        keys[0] = -1;
        keys[10] = records;
        keys[33] = std::int64_t{1} << 32;  // 0 in 32 bits
        keys[74] = std::numeric_limits<std::int64_t>::min();
        auto sorted_keys = draw_keys(key_order::sorted, 75, random);
        sorted_keys[10] += std::int64_t{1} << 32;  // the same in 32 bits
        const auto values = draw_whole_numbers<T>(std::size_t{75} * width, random);
        for (const auto& of : {keys, sorted_keys})
            CHECK(combined_by_kernel<operation::sum>(width, of, values, T{0}) ==
                  combined_in_order<operation::sum>(width, of, values, T{0}));
    }
}

TEST_CASE("keys may be 32-bit numbers, and there may be no rows") {
    const std::vector<unsigned> keys = {3, 39, 3};
    const std::vector<float> values = {1, 2, 4};
    CHECK(combined_by_kernel<operation::sum>(1, keys, values, 0.0f) ==
          combined_in_order<operation::sum>(1, keys, values, 0.0f));
    CHECK(combined_by_kernel<operation::sum>(64, std::vector<unsigned>{}, std::vector<float>{}, 1.0f) ==
          std::vector<float>(records * 64, 1.0f));
}

namespace {

/// The table after a scatter with fixed-point sums.
template <class T, class Add = each_tile_alone>
std::vector<T> fixed_point_sums(unsigned width, const std::vector<std::int64_t>& keys,
                                const std::vector<T>& values, T start, const Add& add = {}) {
    using rows = scatter_rows<T, std::int64_t, row_keys<std::int64_t>, to_fixed_point<T>>;
    constexpr int limbs = fixed_point<T>::limbs;
    const std::size_t size = records * width;
    typename backend::template memory<std::int64_t> key_memory(keys),
        sums(std::vector<std::int64_t>(limbs * size));
    typename backend::template memory<T> value_memory(values), table(std::vector<T>(size, start));
    typename backend::template memory<magnitudes> largest(std::vector<magnitudes>(1));
    backend::launch(
        only_warp<largest_exponent<T>>{{value_memory.data(), keys.size() * width, largest.data()}});
    rows all{value_memory.data(),          keys.size(), width,
             {key_memory.data(), records}, sums.data(), {largest.data(), keys.size()}};
    for (int i = 0; i < limbs; ++i) {
        all.convert.limb = i;
        all.table = sums.data() + i * size;
        add(all);
    }
    all.table = sums.data();
    backend::launch(only_warp<add_fixed_point<rows>>{{all, size, table.data()}});
    return table.download();
}

template <class T>
std::vector<T> draw_floats(std::size_t size, int exponents, std::mt19937_64& random) {
    std::vector<T> values(size);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::uniform_int_distribution<int> exponent(-exponents, 0);
    for (T& v : values) v = static_cast<T>(std::ldexp(unit(random), exponent(random)));
    return values;
}

}  // namespace

TEST_CASE_TEMPLATE("fixed point: the order of the rows changes no bit", T, float, double) {
    std::mt19937_64 random(4);
    for (const unsigned width : {1u, 3u, 4u, 64u}) {
        CAPTURE(width);
        constexpr unsigned n = 90;
        auto keys = draw_keys(key_order::frequent, n, random);
        auto values = draw_floats<T>(std::size_t{n} * width, 30, random);
        const auto expected = fixed_point_sums(width, keys, values, T(0.1));
        for (int shuffle = 0; shuffle < 5; ++shuffle) {
            std::vector<unsigned> order(n);
            std::iota(order.begin(), order.end(), 0u);
            std::ranges::shuffle(order, random);
            if (shuffle == 0) std::ranges::sort(order, {}, [&](unsigned i) { return keys[i]; });
            std::vector<std::int64_t> other_keys(n);
            std::vector<T> other_values(values.size());
            for (unsigned i = 0; i < n; ++i) {
                other_keys[i] = keys[order[i]];
                std::copy_n(&values[std::size_t{order[i]} * width], width,
                            &other_values[std::size_t{i} * width]);
            }
            CHECK(fixed_point_sums(width, other_keys, other_values, T(0.1)) == expected);
        }
    }
}

TEST_CASE_TEMPLATE("fixed point: the error is as stated", T, float, double) {
    std::mt19937_64 random(5);
    for (const int exponents : {0, 20, 60, 100}) {
        CAPTURE(exponents);
        constexpr unsigned n = 500, width = 3;
        const auto keys = draw_keys(key_order::random, n, random);
        const auto values = draw_floats<T>(std::size_t{n} * width, exponents, random);
        const auto sums = fixed_point_sums(width, keys, values, T(0));
        std::vector<long double> expected(records * width);
        long double largest = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            expected[static_cast<std::size_t>(keys[i / width]) * width + i % width] +=
                static_cast<long double>(values[i]);
            largest = std::max(largest, std::abs(static_cast<long double>(values[i])));
        }
        const long double ulp = std::numeric_limits<T>::epsilon() / 2;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            // 500 values leave 53 bits to one value, and there are two limbs for a double.
            const long double left_out = 500 * std::ldexp(largest, fixed_point<T>::limbs == 1 ? -52 : -104);
            CHECK(std::abs(static_cast<long double>(sums[i]) - expected[i]) <=
                  left_out + 2 * ulp * std::abs(expected[i]));
        }
    }
}

TEST_CASE_TEMPLATE("fixed point: extreme values", T, float, double) {
    using limits = std::numeric_limits<T>;
    const std::vector<std::int64_t> keys = {0, 1, 0, 2, 2};
    SUBCASE("zeros") {
        CHECK(fixed_point_sums<T>(1, keys, {0, 0, -T(0), 0, 0}, T(2)) == std::vector<T>(records, T(2)));
    }
    SUBCASE("small") {
        const T small = limits::min() * 64;
        const auto sums = fixed_point_sums<T>(1, keys, {small, 3 * small, small, -small, 0}, T(0));
        CHECK(sums[0] == 2 * small);
        CHECK(sums[1] == 3 * small);
        CHECK(sums[2] == -small);
    }
    SUBCASE("largest") {
        const auto sums = fixed_point_sums<T>(
            1, keys, {limits::max(), limits::max(), limits::max(), limits::max(), -limits::max()}, T(0));
        CHECK(sums[0] == limits::infinity());
        CHECK(sums[1] == limits::max());
        CHECK(sums[2] == 0);
    }
    SUBCASE("not finite") {
        const T infinity = limits::infinity();
        const auto sums =
            fixed_point_sums<T>(1, {0, 1, 0, 2, 2, 3, 4},
                                {infinity, 1, 5, infinity, -infinity, limits::quiet_NaN(), -infinity}, T(1));
        CHECK(sums[0] == infinity);
        CHECK(sums[1] == 2);
        CHECK(std::isnan(sums[2]));
        CHECK(std::isnan(sums[3]));
        CHECK(sums[4] == -infinity);
        CHECK(sums[5] == 1);
    }
}

TEST_CASE("fixed point: the kernels compute the sums of the format") {
    // Values of 2^-40 to 1: a float's 24 bits at 2^-40 are below a unit of a format for 2^20
    // values.
    std::mt19937_64 random(6);
    constexpr unsigned n = 64;
    const auto values = draw_floats<float>(n, 40, random);
    const auto sums = fixed_point_sums(1, draw_keys(key_order::equal, n, random), values, 0.0f);
    unsigned exponent = 0;
    for (const float v : values) exponent = std::max(exponent, fixed_point<float>::exponent(v));
    const auto format = fixed_point<float>::of(exponent, fixed_point<float>::bits_per_value(n));
    std::int64_t limbs[1] = {0};
    for (const float v : values) limbs[0] += format.limb(v, 0);
    CHECK(sums[7] == static_cast<float>(format.value(limbs)));
}

namespace {

/// Blocks whose copies collide, and blocks that have copies of all records.
std::vector<in_blocks> ways_to_divide() {
    std::vector<in_blocks> all;
    for (const unsigned slots : {1u, 3u, 200u}) all.push_back({slots, 2, backend::most_warps});
    all.push_back({3, 5, 1});
    return all;
}

std::vector<std::uint64_t> bits_of(const std::vector<float>& values) {
    std::vector<std::uint64_t> bits;
    for (const float v : values) bits.push_back(std::bit_cast<std::uint32_t>(v));
    return bits;
}
std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
    std::vector<std::uint64_t> bits;
    for (const double v : values) bits.push_back(std::bit_cast<std::uint64_t>(v));
    return bits;
}

}  // namespace

TEST_CASE("in blocks: rows of each width and order are added to the records of their keys") {
    std::mt19937_64 random(7);
    for (const unsigned width : {1u, 3u, 4u, 12u, 20u, 100u})
        for (const key_order order :
             {key_order::random, key_order::sorted, key_order::equal, key_order::frequent}) {
            CAPTURE(width);
            CAPTURE(static_cast<int>(order));
            auto keys = draw_keys(order, 200, random);
            if (order == key_order::frequent) keys[100] = -1, keys[199] = std::int64_t{1} << 32;
            const auto values = draw_whole_numbers<std::int64_t>(std::size_t{200} * width, random);
            const auto sums = combined_in_order<operation::sum>(width, keys, values, std::int64_t{5});
            const auto largest =
                combined_in_order<operation::maximum>(width, keys, values, std::int64_t{-200});
            for (const in_blocks& add : ways_to_divide()) {
                CAPTURE(add.slots);
                CAPTURE(add.warps);
                CHECK(combined_by_kernel<operation::sum>(width, keys, values, std::int64_t{5}, add) == sums);
                if (order == key_order::frequent)
                    CHECK(combined_by_kernel<operation::maximum>(width, keys, values, std::int64_t{-200},
                                                                 add) == largest);
            }
        }
}

TEST_CASE_TEMPLATE("in blocks: fixed-point sums have the bits that they have without blocks", T, float,
                   double) {
    using limits = std::numeric_limits<T>;
    std::mt19937_64 random(8);
    for (const unsigned width : {1u, 4u, 8u, 64u}) {
        CAPTURE(width);
        const auto keys = draw_keys(key_order::frequent, 300, random);
        auto values = draw_floats<T>(std::size_t{300} * width, 30, random);
        for (const bool is_finite : {true, false}) {
            CAPTURE(is_finite);
            if (!is_finite) values[5] = limits::infinity(), values[70] = limits::quiet_NaN();
            const auto expected = bits_of(fixed_point_sums(width, keys, values, T(0.1)));
            for (const in_blocks& add : ways_to_divide())
                CHECK(bits_of(fixed_point_sums(width, keys, values, T(0.1), add)) == expected);
        }
    }
}

namespace {

using copies_of_two = detail::copied_pieces<2, std::int64_t, operation::sum>;

/// Lane i has the piece 9 if i is a multiple of 4, and a piece of its own otherwise.
struct use_of_copies {
    copies_of_two copies;
    lane_bits_t<backend::warp>* found;
    std::int64_t* table;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const unsigned piece = w.lane() % 4 == 0 ? 9 : 10 + w.lane();
        copies.clear(w, 0, 1);
        w.sync();
        const lane_bits_t<W> in_empty_slot = copies.find(w, 0, true);
        w.sync();
        copies.nominate(w, piece, w.lane(), true);
        w.sync();
        const lane_bits_t<W> mine = copies.find(w, piece, true);
        const lane_bits_t<W> inactive = copies.find(w, piece, false);
        if (w.lane() == 0) found[0] = in_empty_slot, found[1] = mine, found[2] = inactive;
        copies.add(w, piece, 1, 3, (mine >> w.lane() & 1) != 0);
        w.sync();
        copies.flush(w, table, 3, 0, 1);  // piece 9 has the last value of record 4
    }
};

}  // namespace

TEST_CASE("in blocks: the piece that most lanes have gets the slot, and only its lanes use the copy") {
    using bits = lane_bits_t<backend::warp>;
    typename backend::template memory<std::int64_t> memory(std::vector<std::int64_t>(1 + 2, -1)),
        table(std::vector<std::int64_t>(6 * 3));
    typename backend::template memory<bits> found(std::vector<bits>(3));
    backend::launch(use_of_copies{{memory.data(), memory.data() + 1, 1}, found.data(), table.data()});
    const bits every_fourth = backend::warp::size == 1 ? 1 : ~bits{0} / 15;
    CHECK(found.download() == std::vector<bits>{0, every_fourth, 0});
    const auto content = memory.download();
    CHECK(static_cast<std::uint32_t>(content[0]) == 9);
    CHECK(content[1] == 0);
    CHECK(content[2] == 3 * std::int64_t{(backend::warp::size + 3) / 4});
    CHECK(table.download() == std::vector<std::int64_t>(6 * 3, 0));  // the second value is past the record
}

TEST_CASE("in blocks: frequent keys reach the table by their copies") {
    // The copy of the only key has the sum of all rows.
    using rows = scatter_rows<std::int64_t, std::int64_t, row_keys<unsigned>>;
    using scatter = scatter_in_blocks<scatter_narrow_rows<4, rows>>;
    std::mt19937_64 random(9);
    const auto values = draw_whole_numbers<std::int64_t>(300 * 4, random);
    typename backend::template memory<unsigned> keys(std::vector<unsigned>(300, 2));
    typename backend::template memory<std::int64_t> of_rows(values), table(std::vector<std::int64_t>(16)),
        memory(std::vector<std::int64_t>(scatter::memory_size<backend::warp>(5)));
    const scatter add{{{of_rows.data(), 300, 4, {keys.data(), 4}, table.data()}}, 5, 1, backend::most_warps};
    backend::launch_block(backend::most_warps, every_block<scatter>{add, memory.data()});
    const auto content = memory.download();
    const auto sums = table.download();
    const auto copy = std::ranges::search(content, std::vector(sums.begin() + 8, sums.begin() + 12));
    CHECK(copy.size() == 4);
}
