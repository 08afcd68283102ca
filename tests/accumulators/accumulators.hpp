// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the accumulate tags promise, on the `backend` that the including file has chosen: errors within their
/// bounds, by the exact sum of an integer of 512 bits of its own; the same bits over permuted orders.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>
#include <warpagg/match_reduce_atomic.hpp>

namespace {

using namespace warpagg;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr double u = 0x1p-24;
constexpr unsigned width = backend::warp::size;
constexpr double log2_width = std::bit_width(width) - 1;

/// A sum of floats without any error, in units of 2^-149: a two's complement of 512 bits, a bit an element.
class exact_sum {
  public:
    void add(float x, int sign = 1) {
        int exponent;
        const auto significand = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 24));
        // The lowest bits of denormals are zero.
        const int place = exponent - 24 + 149;
        const std::int64_t whole = place >= 0 ? significand : significand >> -place;
        add_bits(static_cast<std::uint64_t>(std::abs(whole)), std::max(place, 0), (whole < 0) != (sign < 0));
    }
    /// Good to double's precision.
    double approximately() const {
        std::vector<bool> bits = bits_;
        const bool negative = bits.back();
        if (negative) {
            bool carry = true;
            for (std::size_t i = 0; i < bits.size(); ++i) {
                const bool b = !bits[i];
                bits[i] = b != carry;
                carry = b && carry;
            }
        }
        double sum = 0;
        for (std::size_t i = bits.size(); i-- > 0;)
            if (bits[i]) sum += std::ldexp(1.0, static_cast<int>(i) - 149);
        return negative ? -sum : sum;
    }
    /// The distance of x from it.
    double minus(float x) const {
        exact_sum difference = *this;
        difference.add(x, -1);
        return difference.approximately();
    }
    /// Returns whether no float is nearer to it than x.
    bool is_nearest(float x) const {
        if (!std::isfinite(x)) return std::abs(approximately()) >= 0x1.ffffffp127;
        const double error = std::abs(minus(x));
        for (const float to : {-infinity, infinity}) {
            const float next = std::nextafter(x, to);
            if (!std::isfinite(next)) continue;
            const double other = std::abs(minus(next));
            if (other < error || (other == error && (std::bit_cast<std::uint32_t>(x) & 1u) != 0))
                return false;
        }
        return true;
    }

  private:
    void add_bits(std::uint64_t magnitude, int place, bool negative) {
        bool carry = negative;  // -m is ~m + 1
        for (std::size_t i = 0; i < bits_.size(); ++i) {
            const std::size_t from = static_cast<std::size_t>(place);
            const bool m = i >= from && i - from < 64 && ((magnitude >> (i - from)) & 1u) != 0;
            const bool b = m != negative, a = bits_[i];
            bits_[i] = (a != b) != carry;
            carry = (a && b) || (carry && (a || b));
        }
    }
    std::vector<bool> bits_ = std::vector<bool>(512, false);
};

/// Adds the values, of which each lane has one, twice them and half of them, in their order to three cells.
template <class Policy, class Cells>
struct add_in_order {
    const float* values;
    unsigned n;
    Cells cells;
    Policy how;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        for (unsigned base = 0; base < n; base += W::size) {
            const auto index = w.lane() + base;
            const mask_t<W> active = index < n;
            const auto x = w.load(values, index, active);
            const value_t<W, float> v[3] = {x, x * 2.0f, x * 0.5f};
            warp_reduce_atomic<float, 3>(w, cells, v, active, how);
        }
    }
};

/// The element type of memory for sums that `Accumulate` keeps.
template <class Accumulate>
struct kept_by {
    using type = Accumulate;
};
template <class Accumulate>
struct kept_by<accumulate::between_warps<Accumulate>> {
    using type = Accumulate;
};

template <class Accumulate, class... Tags>
std::vector<float> sums(const std::vector<float>& values, Accumulate how, Tags... tags) {
    using cell = warpagg::accumulator<typename kept_by<Accumulate>::type>;
    typename backend::template memory<float> in(values);
    typename backend::template memory<cell> cells(std::vector<cell>(3));
    const policy all{how, tags...};
    backend::launch(add_in_order<std::remove_const_t<decltype(all)>, cell*>{
        in.data(), static_cast<unsigned>(values.size()), cells.data(), all});
    std::vector<float> result;
    for (const auto& c : cells.download()) {
        result.push_back(c.value());
        if constexpr (requires { how.scale; }) result.back() /= how.scale;
    }
    return result;
}

/// Of a sum whose condition number is about k: pairs that cancel, and a few that stay.
std::vector<float> conditioned(double k, unsigned n, std::mt19937& random) {
    std::normal_distribution<float> normal;
    std::vector<float> values;
    double magnitude = 0;
    while (values.size() + 5 < n) {
        const float x = normal(random);
        values.push_back(x);
        values.push_back(-x);
        magnitude += 2 * std::abs(static_cast<double>(x));
    }
    while (values.size() < n)
        values.push_back(static_cast<float>(magnitude / k / 5) * (1 + 0.1f * std::abs(normal(random))));
    std::ranges::shuffle(values, random);
    return values;
}

struct sizes_of_sum {
    double n, sum, magnitude, largest;
    double k() const { return magnitude / std::abs(sum); }
};

/// Whether each of the three sums is within the bound that the tag has for it.
template <class Accumulate, class Bound>
void check_bound(const std::vector<float>& values, const Accumulate& how, Bound bound,
                 const std::string& name) {
    const std::vector<float> found = sums(values, how);
    for (int i = 0; i < 3; ++i) {
        const float factor = i == 0 ? 1.0f : i == 1 ? 2.0f : 0.5f;
        exact_sum exact;
        sizes_of_sum of{static_cast<double>(values.size()), 0, 0, 0};
        for (const float x : values) {
            exact.add(factor * x);
            of.magnitude += std::abs(static_cast<double>(factor * x));
            of.largest = std::max(of.largest, std::abs(static_cast<double>(factor * x)));
        }
        of.sum = exact.approximately();
        INFO(name << ", n " << values.size() << ", k " << of.k() << ", sum " << of.sum);
        CHECK(std::abs(exact.minus(found[static_cast<std::size_t>(i)])) <= bound(of));
    }
}

/// The bits of the first sum, a NaN's all alike.
std::uint32_t bits_of(float x) { return std::isnan(x) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(x); }

template <class Accumulate>
void check_any_order(std::vector<float> values, const Accumulate& how, const std::string& name) {
    constexpr int orders = backend::every_nth_mask > 1 ? 15 : 100;
    std::mt19937 random(7);
    const std::vector<float> first = sums(values, how);
    int differing = 0;
    for (int i = 0; i < orders; ++i) {
        std::ranges::shuffle(values, random);
        const std::vector<float> again = sums(values, how);
        for (std::size_t k = 0; k < 3; ++k) differing += bits_of(again[k]) != bits_of(first[k]) ? 1 : 0;
    }
    INFO(name);
    CHECK(differing == 0);
}

/// Values that are hard on sums.
std::vector<std::vector<float>> hard_sets() {
    std::mt19937 random(11);
    std::vector<std::vector<float>> sets(6);
    constexpr int n = 200;
    for (int i = 0; i < n; ++i) {
        const auto bits = static_cast<std::uint32_t>(random());
        const float any = std::bit_cast<float>(bits);
        sets[0].push_back(std::isfinite(any) ? any * 0x1p-20f : 0.0f);  // all exponents
        sets[1].push_back(std::bit_cast<float>(bits & 0x807fffffu));    // denormals
        sets[2].push_back(i % 2 == 0 ? 0.0f : -0.0f);
        sets[3].push_back((i % 3 == 0   ? 1e30f
                           : i % 3 == 1 ? -1e30f
                                        : 1e-30f) *
                          (1 + 1e-3f * static_cast<float>(i / 3)));
        sets[4].push_back(std::ldexp(1.0f + 0x1p-23f * static_cast<float>(bits % 8192), i - 120));
        sets[5].push_back((i % 2 == 0 ? 1.0f : -1.0f) * std::numeric_limits<float>::max() * 0.25f);
    }
    sets[4].resize(120);
    return sets;
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE("sums err by no more than their bound, whatever cancels") {
    std::mt19937 random(3);
    constexpr bool is_slow = backend::every_nth_mask > 1;
    for (const unsigned n : is_slow ? std::vector<unsigned>{96} : std::vector<unsigned>{33, 1000, 4096})
        for (const double k : {1.0, 1e3, 1e6, 1e9, 1e12}) {
            const std::vector<float> values = conditioned(k, n, random);
            check_bound(
                values, accumulate::f64{},
                [](auto s) { return (s.n * 0x1p-53 * s.k() + u) * std::abs(s.sum); }, "f64");
            check_bound(
                values, accumulate::compensated{},
                [](auto s) { return (u + 5 * s.n * u * u * s.k()) * std::abs(s.sum); }, "compensated");
            check_bound(
                values, accumulate::fixed<15>{}, [](auto s) { return s.n * 0x1p-16 + u * std::abs(s.sum); },
                "fixed<15>");
            float largest = 0;
            for (const float x : values) largest = std::max(largest, 2 * std::abs(x));
            const float scale = accumulate::fixed<15>::scale_to_fit(largest);
            check_bound(
                values, accumulate::fixed<15>{nullptr, scale},
                [&](auto s) { return s.n * 0x1p-16 / static_cast<double>(scale) + u * std::abs(s.sum); },
                "fixed<15>, scaled to fit");
            check_bound(
                values, accumulate::binned<2>{},
                [](auto s) { return s.n * 0x1p-24 * s.largest + u * std::abs(s.sum); }, "binned<2>");
            check_bound(
                values, accumulate::binned<3>{},
                [](auto s) { return s.n * 0x1p-48 * s.largest + u * std::abs(s.sum); }, "binned<3>");
            check_bound(
                values, accumulate::exact{}, [](auto s) { return u * std::abs(s.sum); }, "exact");
            check_bound(
                values, between_warps(exact),
                [](auto s) { return log2_width * u * s.magnitude + u * std::abs(s.sum); },
                "exact between warps");
        }
}

TEST_CASE("sums of hard values err by no more than their bound") {
    for (const auto& set : hard_sets()) {
        check_bound(
            set, accumulate::binned<2>{},
            [](auto s) { return s.n * 0x1p-24 * s.largest + u * std::abs(s.sum); }, "binned<2>");
        check_bound(
            set, accumulate::binned<4>{},
            [](auto s) { return s.n * 0x1p-72 * s.largest + u * std::abs(s.sum) + 0x1p-150; }, "binned<4>");
    }
}

TEST_CASE("the order of additions does not show") {
    for (const auto& set : hard_sets()) {
        float largest = 0;
        for (const float x : set) largest = std::max(largest, 2 * std::abs(x));
        check_any_order(set, accumulate::fixed<40>{nullptr, accumulate::fixed<40>::scale_to_fit(largest)},
                        "fixed<40>, scaled to fit");
        check_any_order(set, accumulate::binned<2>{}, "binned<2>");
        check_any_order(set, accumulate::binned<3>{}, "binned<3>");
        check_any_order(set, accumulate::exact{}, "exact");
    }
}

TEST_CASE("exact sums are rounded once, to the nearest float") {
    for (const auto& set : hard_sets()) {
        exact_sum whole;
        for (const float x : set) whole.add(x);
        const float sum = sums(set, accumulate::exact{})[0];
        CAPTURE(sum);
        CHECK(whole.is_nearest(sum));
        CHECK(std::bit_cast<std::uint32_t>(sum) != 0x80000000u);
    }
    // To the even one of two; and up from the largest.
    CHECK(sums({1.0f, 0x1p-24f}, accumulate::exact{})[0] == 1.0f);
    CHECK(sums({1.0f, 0x1p-24f, 0x1p-149f}, accumulate::exact{})[0] == 1.0f + 0x1p-23f);
    CHECK(sums({1.0f + 0x1p-23f, 0x1p-24f}, accumulate::exact{})[0] == 1.0f + 0x1p-22f);
    CHECK(sums({-0x1p-126f, 0x1p-149f}, accumulate::exact{})[0] == -0x1.fffffcp-127f);
    const float largest = std::numeric_limits<float>::max();
    CHECK(sums({largest, 0x1p102f}, accumulate::exact{})[0] == largest);
    CHECK(sums({largest, 0x1p103f}, accumulate::exact{})[0] == infinity);
    CHECK(sums({largest, largest, -largest}, accumulate::exact{})[0] == largest);
}

TEST_CASE("infinities and NaN add up as they do one after the other") {
    const auto check = [](const std::vector<float>& values, float sum) {
        CHECK(bits_of(sums(values, accumulate::exact{})[0]) == bits_of(sum));
        CHECK(bits_of(sums(values, accumulate::binned<3>{})[0]) == bits_of(sum));
        CHECK(bits_of(sums(values, accumulate::f64{})[0]) == bits_of(sum));
        CHECK(bits_of(sums(values, accumulate::compensated{})[0]) == bits_of(sum));
    };
    check({1, infinity, -5}, infinity);
    check({-infinity, 1e38f, -infinity}, -infinity);
    check({infinity, 2, -infinity}, nan_value);
    check({1, nan_value, 3}, nan_value);
    check({}, 0);
    check({-0.0f}, 0);
}

TEST_CASE("fixed says what does not fit, and leaves it out") {
    const auto faults = [](const std::vector<float>& values, float scale) {
        typename backend::template memory<std::uint32_t> fault(std::vector<std::uint32_t>{0});
        const float sum = sums(values, accumulate::fixed<20>{fault.data(), scale})[0];
        return std::pair{fault.download()[0], sum};
    };
    using found = std::pair<std::uint32_t, float>;
    CHECK(faults({1.5f, 2.25f, -1}, 1) == found{0, 2.75f});
    // Of which each lane has twice as much in another component: 2^18 is the first that does not fit there.
    CHECK(faults({1.5f, 131071, -1}, 1) == found{0, 131071.5f});
    CHECK(faults({1.5f, 131072, -1}, 1) == found{1, 131072.5f});
    CHECK(faults({1.5f, 262144, -1}, 1) == found{1, 0.5f});
    CHECK(faults({1.5f, infinity, -1}, 1) == found{1, 0.5f});
    CHECK(faults({1.5f, nan_value, -1}, 1) == found{1, 0.5f});
    CHECK(faults({1.5f, 262144, -1}, 0.125f) == found{0, 262144.5f});
    // The largest there is that fits: each lane has twice as much in another component.
    for (const float largest :
         {1e-30f, 1e-20f, 0.3f, 1.0f, 1.5f, 3.0f, 1e5f, 1e30f, std::numeric_limits<float>::max()}) {
        const float scale = accumulate::fixed<20>::scale_to_fit(largest);
        CAPTURE(largest);
        CHECK(faults({0.5f * largest, -0.25f * largest}, scale).first == 0);
        CHECK(faults({0.5f * largest, -0.25f * largest}, 2 * scale).first == 1);
    }
    // The fewer values, the larger they may be.
    const auto fault_of_few = [](float x) {
        typename backend::template memory<std::uint32_t> fault(std::vector<std::uint32_t>{0});
        sums({0.5f * x}, accumulate::fixed<20, 10>{fault.data(), 1});  // and twice that
        return fault.download()[0];
    };
    CHECK(fault_of_few(0x1.fffffep32f) == 0);
    CHECK(fault_of_few(0x1p33f) == 1);
    CHECK(accumulate::fixed<20>::scale_to_fit(1e-40f) == 0x1p126f);
    CHECK(accumulate::fixed<20>::scale_to_fit(0) == 1);
}

namespace {

template <class T>
struct every_other_cell {
    T* first;
    WARPAGG_HD T* operator()(unsigned i) const { return first + 2 * i; }
};
template <class T>
struct cell_by_key {
    T* first;
    WARPAGG_HD T* operator()(unsigned key, unsigned i) const { return first + (3 * i + key); }
};

/// What no single record shows: lanes that take no part, accessors, and keys.
template <class Accumulate>
struct add_by_accessors {
    accumulator<Accumulate>* strided;
    accumulator<Accumulate>* by_key;
    accumulator<Accumulate>* by_key_and_component;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        using math::select;
        for (unsigned base = 0; base < 96; base += W::size) {
            const auto index = w.lane() + base;
            const mask_t<W> active = index < 96u && index % 3u != 1u;
            const auto x =
                select(active, math::convert<float>(math::convert<int>(index)), value_t<W, float>(nan_value));
            const value_t<W, float> v[2] = {x, x * -1.0f};
            const policy how{Accumulate{}};
            warp_reduce_atomic(w, every_other_cell<accumulator<Accumulate>>{strided}, v, active, how);
            warp_reduce_atomic(w, every_other_cell<accumulator<Accumulate>>{strided}, v, mask_t<W>(false),
                               how);
            warp_match_reduce_atomic(w, by_key, index % 3u, v, active, how);
            warp_match_reduce_atomic(w, cell_by_key<accumulator<Accumulate>>{by_key_and_component},
                                     index % 3u, v, active, policy{Accumulate{}, per_lane});
        }
    }
};

template <class Accumulate>
void check_accessors(const std::string& name) {
    using cells = std::vector<accumulator<Accumulate>>;
    typename backend::template memory<accumulator<Accumulate>> strided(cells(4)), by_key(cells(6)),
        transposed(cells(6));
    backend::launch(add_by_accessors<Accumulate>{strided.data(), by_key.data(), transposed.data()});
    float sum[3] = {};
    for (int i = 0; i < 96; ++i) sum[i % 3] += i % 3 == 1 ? 0.0f : static_cast<float>(i);
    INFO(name);
    const cells s = strided.download(), k = by_key.download(), t = transposed.download();
    CHECK(s[0].value() == sum[0] + sum[2]);
    CHECK(s[1].value() == 0);
    CHECK(s[2].value() == -sum[0] - sum[2]);
    for (std::size_t key = 0; key < 3; ++key) {
        CHECK(k[2 * key].value() == sum[key]);
        CHECK(k[2 * key + 1].value() == -sum[key]);
        CHECK(t[key].value() == sum[key]);
        CHECK(t[3 + key].value() == -sum[key]);
    }
}

}  // namespace

TEST_CASE("accumulators behind accessors and keys") {
    check_accessors<accumulate::f64>("f64");
    check_accessors<accumulate::compensated>("compensated");
    check_accessors<accumulate::fixed<10>>("fixed<10>");
    check_accessors<accumulate::binned<3>>("binned<3>");
    check_accessors<accumulate::exact>("exact");
}

namespace {

template <class Accumulate>
void check_policies(const std::string& name) {
    const std::vector<float> values = hard_sets()[3];
    const Accumulate how{};
    const std::vector<float> as_default = sums(values, how);
    INFO(name);
    CHECK(sums(values, how, per_lane) == as_default);
    CHECK(sums(values, how, shfl_down) == as_default);
    CHECK(sums(values, how, butterfly, contiguous) == as_default);
    CHECK(sums(values, how, at_least<20>) == as_default);
    CHECK(sums(values, how, scatter, add_zeros) == as_default);
}

}  // namespace

TEST_CASE("whatever else a policy says, the sums are the same") {
    check_policies<accumulate::binned<3>>("binned<3>");
    check_policies<accumulate::exact>("exact");
}

namespace {

/// Of policies that leave it to different lanes to commit: values that warps hand on without an error, so
/// that memory's sums are exact ones.
template <class Kept>
void check_between_warps(const Kept& how, const std::string& name) {
    std::mt19937 random(5);
    std::vector<float> values;
    for (int i = 0; i < 300; ++i)  // multiples of 2^-10 below 2^8: a warp's sum has 24 bits
        values.push_back(static_cast<float>(static_cast<int>(random() % 0x40000u)) * 0x1p-10f - 128.0f);
    const auto sums_between = [&](auto... tags) { return sums(values, between_warps(how), tags...); };
    const std::vector<float> expected = sums(values, how);
    INFO(name);
    CHECK(sums_between() == expected);
    CHECK(sums_between(per_lane) == expected);
    CHECK(sums_between(shfl_down) == expected);
    CHECK(sums_between(butterfly, contiguous) == expected);
    CHECK(sums_between(scatter, assume_busy) == expected);
    CHECK(sums_between(at_least<20>) == expected);
}

/// Warps' values, each warp's in its order, but the warps in any.
template <class Kept>
void check_any_order_of_warps(std::vector<float> values, const Kept& how, const std::string& name) {
    std::mt19937 random(7);
    constexpr std::size_t warp = backend::warp::size;
    values.resize(values.size() / warp * warp);
    const std::vector<float> first = sums(values, between_warps(how));
    int differing = 0;
    for (int order = 0; order < 20; ++order) {
        for (std::size_t i = values.size() / warp; i > 1; --i)
            std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>((i - 1) * warp),
                             values.begin() + static_cast<std::ptrdiff_t>(i * warp),
                             values.begin() + static_cast<std::ptrdiff_t>(random() % i * warp));
        const std::vector<float> again = sums(values, between_warps(how));
        for (std::size_t k = 0; k < 3; ++k) differing += bits_of(again[k]) != bits_of(first[k]) ? 1 : 0;
    }
    INFO(name);
    CHECK(differing == 0);
}

}  // namespace

TEST_CASE("between warps sums are kept as they say") {
    check_between_warps(accumulate::f64{}, "f64");
    check_between_warps(accumulate::compensated{}, "compensated");
    check_between_warps(accumulate::fixed<12>{}, "fixed<12>");
    check_between_warps(accumulate::binned<2>{}, "binned<2>");
    check_between_warps(accumulate::exact{}, "exact");
    for (const auto& set : hard_sets()) {
        float largest = 0;
        for (const float x : set) largest = std::max(largest, 2 * width * std::abs(x));
        check_any_order_of_warps(
            set, accumulate::fixed<40>{nullptr, accumulate::fixed<40>::scale_to_fit(largest)}, "fixed<40>");
        check_any_order_of_warps(set, accumulate::binned<3>{}, "binned<3>");
        check_any_order_of_warps(set, accumulate::exact{}, "exact");
    }
}

TEST_CASE("between warps fixed says what does not fit") {
    typename backend::template memory<std::uint32_t> fault(std::vector<std::uint32_t>{0});
    using kept = accumulate::fixed<20>;
    const std::vector<float> fits{1.5f, 65536.0f}, does_not{1.5f, 262144.0f};
    CHECK(sums(fits, between_warps(kept{fault.data()}))[0] == 65537.5f);
    CHECK(fault.download()[0] == 0);
    CHECK(sums(does_not, between_warps(kept{fault.data()}))[0] == (backend::warp::size == 1 ? 1.5f : 0.0f));
    CHECK(fault.download()[0] == 1);
}

TEST_CASE("infinities of binned do not count, they are there or not") {
    for (const float x : {infinity, -infinity, nan_value}) {
        using binned = accumulate::binned<3>;
        std::uint64_t sum[binned::limbs];
        binned::decompose(x, sum);
        for (int doubled = 0; doubled < 40; ++doubled)
            for (auto& word : sum) word = binned::operation::combine_words(word, word);
        CHECK(bits_of(binned::value(sum)) == bits_of(x));
    }
}

TEST_SUITE_END();
