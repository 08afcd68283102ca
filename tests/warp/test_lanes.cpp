// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The SIMD lanes, and the warp made of them, against loops over 32 scalars.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>
#include <warpagg/warp/simd.hpp>

namespace {

constexpr int count = 32;
constexpr int rounds = 50;

template <class T>
using vector = warpagg::simd_value<T, count>;
template <class T>
using scalars = std::array<T, count>;

const warpagg::emulator::lanes warp{};

template <class T>
vector<T> vector_of(const scalars<T>& a) {
    vector<T> r;
    for (int i = 0; i < count; ++i) r.set(i, a[static_cast<std::size_t>(i)]);
    return r;
}

template <class T>
bool same_bits(const vector<T>& a, const scalars<T>& b) {
    for (int i = 0; i < count; ++i) {
        const T x = a[i], y = b[static_cast<std::size_t>(i)];
        if (std::memcmp(&x, &y, sizeof(T)) != 0) return false;
    }
    return true;
}

template <class F>
auto each(F f) {
    scalars<decltype(f(std::size_t{0}))> r;
    for (std::size_t i = 0; i < count; ++i) r[i] = f(i);
    return r;
}

/// Small numbers, so that equal ones meet and integers neither overflow nor, once a zero is replaced, divide
/// by zero.
template <class T>
T draw(std::mt19937& random) {
    const auto small = static_cast<int>(random() % 201) - 100;
    if constexpr (std::is_same_v<T, bool>) {
        return small > 0;
    } else if constexpr (std::is_floating_point_v<T>) {
        return random() % 8 == 0 ? T(small) : T(small) * static_cast<T>(random()) / T(7e8);
    } else if constexpr (std::is_signed_v<T>) {
        return static_cast<T>(small);
    } else {
        return static_cast<T>(random() % 4 == 0 ? static_cast<unsigned>(small + 100) : random());
    }
}

template <class T>
scalars<T> draw_all(std::mt19937& random) {
    return each([&](std::size_t) { return draw<T>(random); });
}

/// f(scalars a, scalars b) for several random operands.
template <class T, class F>
void for_random_pairs(F f) {
    std::mt19937 random(11);
    for (int round = 0; round < rounds; ++round) {
        const auto a = draw_all<T>(random);
        const auto b = draw_all<T>(random);
        f(a, b);
    }
}

/// Promoted first: compilers doubt & and | of bools.
#define CHECK_OPERATOR(op)                              \
    do {                                                \
        const auto expected = each([&](std::size_t i) { \
            const auto x = +a[i], y = +b[i];            \
            return static_cast<T>(x op y);              \
        });                                             \
        CHECK(same_bits(va op vb, expected));           \
        vector<T> in_place = va;                        \
        in_place op## = vb;                             \
        CHECK(same_bits(in_place, expected));           \
    } while (false)

#define CHECK_COMPARISON(op) \
    CHECK(same_bits(va op vb, each([&](std::size_t i) { return static_cast<bool>(a[i] op b[i]); })))

template <class T>
scalars<T> without_zeros(scalars<T> a) {
    for (T& x : a) x = x == T(0) ? T(3) : x;
    return a;
}

/// One bit per lane.
scalars<bool> flags_of(std::uint32_t mask) {
    return each([&](std::size_t i) { return ((mask >> i) & 1u) != 0; });
}
vector<bool> lanes_of(std::uint32_t mask) { return vector_of(flags_of(mask)); }

std::vector<std::uint32_t> some_masks() {
    std::vector<std::uint32_t> masks{0u, 0xffffffffu, 1u, 0x80000000u, 0x00ff00ffu};
    std::mt19937 random(5);
    for (int i = 0; i < 20; ++i) masks.push_back(static_cast<std::uint32_t>(random()));
    return masks;
}

/// An index no array here reaches.
constexpr unsigned far_away = 0x7ffffff0u;

/// Where active lanes find their value, in an order that is not the lanes'; nowhere, for inactive ones.
scalars<unsigned> scattered_indices(std::uint32_t mask) {
    return each([&](std::size_t i) {
        return ((mask >> i) & 1u) != 0 ? static_cast<unsigned>((i * 13 + 5) % 32) : far_away;
    });
}

}  // namespace

TEST_SUITE_BEGIN("lanes");

TEST_CASE_TEMPLATE("arithmetic", T, float, double, std::int32_t, std::uint32_t) {
    for_random_pairs<T>([](const scalars<T>& a, const scalars<T>& drawn) {
        const scalars<T> b = without_zeros(drawn);
        const auto va = vector_of(a), vb = vector_of(b);
        CHECK_OPERATOR(+);
        CHECK_OPERATOR(-);
        CHECK_OPERATOR(*);
        CHECK_OPERATOR(/);
        CHECK(same_bits(-va, each([&](std::size_t i) { return static_cast<T>(-a[i]); })));
        if constexpr (std::is_integral_v<T>) {
            CHECK_OPERATOR(%);
            CHECK_OPERATOR(&);
            CHECK_OPERATOR(|);
            CHECK_OPERATOR(^);
        }
    });
}

TEST_CASE("shifts") {
    for_random_pairs<std::uint32_t>([](const auto& a, const auto& drawn) {
        using T = std::uint32_t;
        const auto b = each([&](std::size_t i) { return drawn[i] % 32; });
        const auto va = vector_of(a), vb = vector_of(b);
        CHECK_OPERATOR(<<);
        CHECK_OPERATOR(>>);
    });
}

TEST_CASE_TEMPLATE("comparisons", T, float, double, std::int32_t, std::uint32_t) {
    for_random_pairs<T>([](const scalars<T>& a, const scalars<T>& drawn) {
        scalars<T> b = drawn;
        for (std::size_t i = 0; i < count; i += 3) b[i] = a[i];
        if constexpr (std::is_floating_point_v<T>) b[1] = std::numeric_limits<T>::quiet_NaN();
        const auto va = vector_of(a), vb = vector_of(b);
        CHECK_COMPARISON(<);
        CHECK_COMPARISON(<=);
        CHECK_COMPARISON(>);
        CHECK_COMPARISON(>=);
        CHECK_COMPARISON(==);
        CHECK_COMPARISON(!=);
    });
}

TEST_CASE("logic") {
    for_random_pairs<bool>([](const scalars<bool>& a, const scalars<bool>& b) {
        using T = bool;
        const auto va = vector_of(a), vb = vector_of(b);
        CHECK_OPERATOR(&);
        CHECK_OPERATOR(|);
        CHECK_OPERATOR(^);
        CHECK_COMPARISON(==);
        CHECK_COMPARISON(!=);
        CHECK_COMPARISON(&&);
        CHECK_COMPARISON(||);
        CHECK(same_bits(!va, each([&](std::size_t i) { return !a[i]; })));
    });
}

TEST_CASE_TEMPLATE("a scalar is the same in every lane", T, float, double, std::int32_t, std::uint32_t,
                   bool) {
    for_random_pairs<T>([](const scalars<T>& a, const scalars<T>&) {
        CHECK(same_bits(vector<T>(a[0]), each([&](std::size_t) { return a[0]; })));
    });
    if constexpr (std::is_floating_point_v<T>) {
        const auto va = vector<T>(T(3));
        CHECK(same_bits(va * T(2) + T(1), each([](std::size_t) { return T(7); })));
        CHECK(same_bits(vector<T>(T(-0.0)), each([](std::size_t) { return T(-0.0); })));
        CHECK(std::isinf(vector<T>(std::numeric_limits<T>::infinity())[31]));
        CHECK(std::isnan(vector<T>(std::numeric_limits<T>::quiet_NaN())[31]));
    }
}

TEST_CASE_TEMPLATE("lanes are read and set one by one", T, float, double, std::int32_t, std::uint32_t, bool) {
    for_random_pairs<T>([](const scalars<T>& a, const scalars<T>& b) {
        auto v = vector_of(a);
        CHECK(same_bits(v, a));
        auto expected = a;
        for (int i = 0; i < count; i += 5) {
            v.set(i, b[static_cast<std::size_t>(i)]);
            expected[static_cast<std::size_t>(i)] = b[static_cast<std::size_t>(i)];
        }
        CHECK(same_bits(v, expected));
    });
}

TEST_CASE_TEMPLATE("select", T, float, double, std::int32_t, std::uint32_t, bool) {
    std::mt19937 random(3);
    for (const std::uint32_t mask : some_masks()) {
        const auto a = draw_all<T>(random), b = draw_all<T>(random);
        const auto flags = flags_of(mask);
        CHECK(same_bits(select(lanes_of(mask), vector_of(a), vector_of(b)),
                        each([&](std::size_t i) { return flags[i] ? a[i] : b[i]; })));
        CHECK(same_bits(select(lanes_of(mask), vector_of(a), b[0]),
                        each([&](std::size_t i) { return flags[i] ? a[i] : b[0]; })));
    }
}

TEST_CASE("select drops NaN and infinity") {
    const vector<float> nan(std::numeric_limits<float>::quiet_NaN());
    CHECK(same_bits(select(lanes_of(0u), nan, 0.0f), each([](std::size_t) { return 0.0f; })));
}

TEST_CASE_TEMPLATE("min and max", T, float, double, std::int32_t, std::uint32_t) {
    for_random_pairs<T>([](const scalars<T>& a, const scalars<T>& b) {
        const auto va = vector_of(a), vb = vector_of(b);
        CHECK(same_bits(min(va, vb), each([&](std::size_t i) { return std::min(a[i], b[i]); })));
        CHECK(same_bits(max(va, vb), each([&](std::size_t i) { return std::max(a[i], b[i]); })));
        CHECK(same_bits(min(va, b[0]), each([&](std::size_t i) { return std::min(a[i], b[0]); })));
        CHECK(same_bits(max(va, b[0]), each([&](std::size_t i) { return std::max(a[i], b[0]); })));
        // The scalar counterparts of the other models.
        CHECK(same_bits(min(va, vb), each([&](std::size_t i) { return warpagg::math::min(a[i], b[i]); })));
        CHECK(same_bits(max(va, vb), each([&](std::size_t i) { return warpagg::math::max(a[i], b[i]); })));
    });
}

TEST_CASE_TEMPLATE("a bound that is no NaN bounds a NaN", T, float, double) {
    using warpagg::math::not_above;
    using warpagg::math::not_below;
    for_random_pairs<T>([](const scalars<T>& a, scalars<T> bound) {
        for (T& b : bound)
            if (std::isnan(b)) b = T(1);
        const auto most = each([&](std::size_t i) { return a[i] < bound[i] ? a[i] : bound[i]; });
        const auto least = each([&](std::size_t i) { return a[i] > bound[i] ? a[i] : bound[i]; });
        CHECK(same_bits(not_above(vector_of(a), vector_of(bound)), most));
        CHECK(same_bits(not_below(vector_of(a), vector_of(bound)), least));
        CHECK(same_bits(vector_of(most), each([&](std::size_t i) { return not_above(a[i], bound[i]); })));
        CHECK(same_bits(vector_of(least), each([&](std::size_t i) { return not_below(a[i], bound[i]); })));
    });
}

TEST_CASE_TEMPLATE("fma rounds once", T, float, double) {
    bool twice_differs = false;
    std::mt19937 random(9);
    for (int round = 0; round < rounds; ++round) {
        const auto a = draw_all<T>(random), b = draw_all<T>(random);
        // Near -a b, where a second rounding loses most.
        const auto c = each([&](std::size_t i) {
            const volatile T product = a[i] * b[i];
            return static_cast<T>(-product);
        });
        const auto expected = each([&](std::size_t i) { return std::fma(a[i], b[i], c[i]); });
        CHECK(same_bits(fma(vector_of(a), vector_of(b), vector_of(c)), expected));
        for (const T x : expected) twice_differs = twice_differs || x != T(0);
    }
    CHECK(twice_differs);
}

TEST_CASE_TEMPLATE("sqrt is rounded correctly", T, float, double) {
    for_random_pairs<T>([](const scalars<T>& drawn, const scalars<T>&) {
        auto a = each([&](std::size_t i) { return std::fabs(drawn[i]); });
        a[0] = std::numeric_limits<T>::infinity();
        a[1] = T(-0.0);
        a[2] = std::numeric_limits<T>::max();
        CHECK(same_bits(sqrt(vector_of(a)), each([&](std::size_t i) { return std::sqrt(a[i]); })));
    });
    CHECK(std::isnan(sqrt(vector<T>(T(-1)))[7]));
    CHECK(inverse_sqrt(vector<T>(T(2)))[3] == 1 / std::sqrt(T(2)));
    CHECK(warpagg::math::inverse_sqrt(T(2)) == 1 / std::sqrt(T(2)));
}

TEST_CASE("convert") {
    for_random_pairs<float>([](const scalars<float>& drawn, const scalars<float>&) {
        const auto a = each([&](std::size_t i) { return drawn[i] + 500.0f; });  // as unsigned, too
        const auto v = vector_of(a);
        CHECK(same_bits(warpagg::convert<float>(v), a));
        CHECK(same_bits(warpagg::convert<double>(v), each([&](std::size_t i) { return double{a[i]}; })));
        CHECK(same_bits(warpagg::convert<std::int32_t>(v),
                        each([&](std::size_t i) { return static_cast<std::int32_t>(a[i]); })));
        CHECK(same_bits(warpagg::convert<std::uint32_t>(v),
                        each([&](std::size_t i) { return static_cast<std::uint32_t>(a[i]); })));
    });
    for_random_pairs<double>([](const scalars<double>& a, const scalars<double>&) {
        CHECK(same_bits(warpagg::convert<float>(vector_of(a)),
                        each([&](std::size_t i) { return static_cast<float>(a[i]); })));
    });
    for_random_pairs<std::uint32_t>([](const auto& a, const auto&) {
        CHECK(same_bits(warpagg::convert<float>(vector_of(a)),
                        each([&](std::size_t i) { return static_cast<float>(a[i]); })));
        CHECK(same_bits(warpagg::convert<double>(vector_of(a)),
                        each([&](std::size_t i) { return static_cast<double>(a[i]); })));
    });
    for_random_pairs<std::int32_t>([](const auto& a, const auto&) {
        CHECK(same_bits(warpagg::convert<float>(vector_of(a)),
                        each([&](std::size_t i) { return static_cast<float>(a[i]); })));
    });
}

TEST_CASE("exp2 of a float errs by less than 1 ulp") {
    constexpr int samples = 1 << 22;  // even in [-126, 128), which is denser than floats' own bits demand
    double worst = 0;
    for (int first = 0; first < samples; first += count) {
        const auto x = each([&](std::size_t i) {
            return static_cast<float>(-126.0 + 254.0 * (first + static_cast<int>(i)) / samples);
        });
        const auto y = exp2(vector_of(x));
        for (int i = 0; i < count; ++i) {
            const double exact = std::exp2(double{x[static_cast<std::size_t>(i)]});
            const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
            worst = std::max(worst, std::fabs(double{y[i]} - exact) / ulp);
        }
    }
    MESSAGE("worst: ", worst, " ulp");
    CHECK(worst <= 1.0);
}

TEST_CASE("exp2 where it is exact, and out of its range") {
    for (int n = -126; n < 128; ++n)
        CHECK(exp2(vector<float>(static_cast<float>(n)))[n & 31] == std::ldexp(1.0f, n));
    const float least = std::ldexp(1.0f, -126);
    for (const float x : {-126.0f, -126.25f, -127.0f, -150.0f, -1e10f, -1e38f})
        CHECK(exp2(vector<float>(x))[13] == least);
    CHECK(exp2(vector<float>(-std::numeric_limits<float>::infinity()))[0] == least);
    const float most = exp2(vector<float>(std::nextafter(128.0f, 0.0f)))[31];
    CHECK(most > std::ldexp(1.0f, 127));
    CHECK(std::isfinite(most));
    for (const float x : {128.0f, 1e10f, std::numeric_limits<float>::infinity()})
        CHECK(exp2(vector<float>(x))[5] == most);
}

TEST_CASE("exp2 of a double") {
    for_random_pairs<double>([](const scalars<double>& a, const scalars<double>&) {
        CHECK(same_bits(exp2(vector_of(a)), each([&](std::size_t i) { return std::exp2(a[i]); })));
    });
}

TEST_CASE("log2 of a float errs by less than 3 ulp") {
    // Even in [-126, 128), and as much again about 1, where the logarithm is small.
    constexpr int samples = 1 << 21;
    double worst = 0;
    for (int first = 0; first < 2 * samples; first += count) {
        const auto x = each([&](std::size_t i) {
            const int k = first + static_cast<int>(i);
            return static_cast<float>(k < samples
                                          ? std::exp2(-126.0 + 254.0 * k / samples)
                                          : std::exp2(static_cast<double>(k - samples) / samples - 0.5));
        });
        const auto y = log2(vector_of(x));
        for (int i = 0; i < count; ++i) {
            const double exact = std::log2(double{x[static_cast<std::size_t>(i)]});
            const double ulp = std::ldexp(1.0, std::ilogb(exact == 0 ? 1e-30 : exact) - 23);
            worst = std::max(worst, std::fabs(double{y[i]} - exact) / ulp);
        }
    }
    MESSAGE("worst: ", worst, " ulp");
    CHECK(worst <= 3.0);
}

TEST_CASE("log2 where it is exact, of zero, and of a double") {
    for (int n = -126; n < 128; ++n)
        CHECK(log2(vector<float>(std::ldexp(1.0f, n)))[n & 31] == static_cast<float>(n));
    CHECK(log2(vector<float>(0.0f))[3] == -127.0f);
    for (const double x : {0.3, 1.0, 7e300}) CHECK(log2(vector<double>(x))[7] == std::log2(x));
}

TEST_CASE("the lanes' numbers") {
    CHECK(same_bits(warp.lane(), each([](std::size_t i) { return static_cast<unsigned>(i); })));
}

TEST_CASE_TEMPLATE("shuffles, at every distance", T, float, double, std::int32_t, std::uint32_t, bool) {
    std::mt19937 random(13);
    for (unsigned distance = 0; distance < count; ++distance) {
        const auto a = draw_all<T>(random);
        const auto v = vector_of(a);
        INFO("distance ", distance);
        CHECK(same_bits(warp.shfl(v, distance), each([&](std::size_t) { return a[distance]; })));
        CHECK(same_bits(warp.shfl(v, distance + count), each([&](std::size_t) { return a[distance]; })));
        CHECK(same_bits(warp.shfl_down(v, distance),
                        each([&](std::size_t i) { return i + distance < count ? a[i + distance] : a[i]; })));
        CHECK(same_bits(warp.shfl_xor(v, distance), each([&](std::size_t i) { return a[i ^ distance]; })));
    }
}

TEST_CASE("votes") {
    for (const std::uint32_t mask : some_masks()) {
        CHECK(warp.ballot(lanes_of(mask)) == mask);
        CHECK(warp.any(lanes_of(mask)) == (mask != 0));
    }
    for (unsigned lane = 0; lane < count; ++lane) CHECK(warp.ballot(lanes_of(1u << lane)) == 1u << lane);
}

TEST_CASE_TEMPLATE("inactive lanes load nothing", T, float, double, std::int32_t, std::uint32_t) {
    std::mt19937 random(17);
    for (const std::uint32_t mask : some_masks()) {
        const auto drawn = draw_all<T>(random);
        const std::vector<T> memory(drawn.begin(), drawn.end());  // on the heap, for the address sanitiser
        const auto index = scattered_indices(mask);
        CHECK(same_bits(warp.load(memory.data(), vector_of(index), lanes_of(mask)),
                        each([&](std::size_t i) { return index[i] == far_away ? T{} : memory[index[i]]; })));
    }
}

TEST_CASE_TEMPLATE("records are loaded and stored by four and four values", T, float, double, std::uint32_t) {
    std::mt19937 random(29);
    constexpr std::size_t stride = 8;
    for (const std::uint32_t mask : some_masks()) {
        std::vector<T> memory(stride * count);  // on the heap, for the address sanitizer
        for (T& x : memory) x = draw<T>(random);
        const auto record = each([&](std::size_t i) {
            const unsigned place = scattered_indices(mask)[i];
            return place == far_away ? far_away : static_cast<unsigned>(stride) * place;
        });
        vector<T> v[stride];
        warp.load_packed(memory.data(), vector_of(record), v, lanes_of(mask));
        std::vector<T> stored(memory.size(), T(7)), expected = stored;
        for (std::size_t k = 0; k < stride; ++k) {
            CHECK(same_bits(v[k], each([&](std::size_t i) {
                                return record[i] == far_away ? T{} : memory[record[i] + k];
                            })));
            for (std::size_t i = 0; i < count; ++i)
                if (record[i] != far_away) expected[record[i] + k] = memory[record[i] + k];
        }
        warp.store_packed(stored.data(), vector_of(record), v, lanes_of(mask));
        CHECK(stored == expected);
    }
}

TEST_CASE_TEMPLATE("inactive lanes store nothing", T, float, double, std::int32_t, std::uint32_t) {
    std::mt19937 random(19);
    for (const std::uint32_t mask : some_masks()) {
        const auto before = draw_all<T>(random), a = draw_all<T>(random);
        std::vector<T> memory(before.begin(), before.end()), expected = memory;
        const auto index = scattered_indices(mask);
        for (std::size_t i = 0; i < count; ++i)
            if (index[i] != far_away) expected[index[i]] = a[i];
        warp.store(memory.data(), vector_of(index), vector_of(a), lanes_of(mask));
        CHECK(memory == expected);
    }
}

TEST_CASE_TEMPLATE("active lanes add, in their order", T, float, double, std::int32_t, std::uint32_t) {
    std::mt19937 random(23);
    for (const std::uint32_t mask : some_masks()) {
        const auto before = draw_all<T>(random), a = draw_all<T>(random);
        std::vector<T> memory(before.begin(), before.end()), expected = memory;
        // Some lanes meet at one address; that of an inactive lane is not even asked for.
        const auto index = each([&](std::size_t i) {
            return ((mask >> i) & 1u) != 0 ? static_cast<unsigned>(i * i % 7) : far_away;
        });
        for (std::size_t i = 0; i < count; ++i)
            if (index[i] != far_away) expected[index[i]] = static_cast<T>(expected[index[i]] + a[i]);
        bool asked_far_away = false;
        const auto address = [&](unsigned i) {
            asked_far_away = asked_far_away || i == far_away;
            return memory.data() + i % 32;
        };
        warp.atomic(warpagg::operation::sum{}, address, vector_of(index), vector_of(a), lanes_of(mask));
        CHECK(memory == expected);
        CHECK_FALSE(asked_far_away);
    }
}

TEST_SUITE_END();
